// SPDX-License-Identifier: MIT
#include "cli/report.hpp"

#include <filesystem>
#include <iostream>
#include <optional>

#include "cli/command.hpp"
#include "io/files.hpp"
#include "io/progress.hpp"
#include "study/report.hpp"

namespace sphstab::cli {

int run_report(const ReportOptions& options) {
  const study::ReportMaker& maker = study::find_report(options.name);
  // The folder is opened before the work, so that a place where nothing can be written is known at once.
  std::optional<io::OutputFolder> folder;
  const std::filesystem::path path = std::filesystem::path(options.output) / std::string(maker.name);
  if (!options.check) folder.emplace(path, options.overwrite ? io::Existing::replace : io::Existing::refuse);

  const study::Report report = [&] {
    io::Progress bar{std::string(maker.name)};
    return maker.make([&](double fraction) { bar.show(fraction); });
  }();
  std::cout << report.summary;
  if (folder) {
    for (const auto& [name, text] : report.files) folder->write(name, text);
    folder->commit();
    std::cout << "\nWritten to " << path.string() << ":";
    for (const auto& [name, text] : report.files) std::cout << " " << name;
    std::cout << "\n";
  }
  for (const std::string& failure : report.failures) std::cerr << "sphstab: claim does not hold: " << failure << "\n";
  return report.failures.empty() ? ExitStatus::done : ExitStatus::claim_fails;
}

}  // namespace sphstab::cli

// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>

#include "cli/case_options.hpp"
#include "cli/command.hpp"
#include "cli/interruption.hpp"
#include "cli/report.hpp"
#include "cli/table.hpp"
#include "io/document.hpp"
#include "io/files.hpp"
#include "io/progress.hpp"
#include "study/report.hpp"

namespace sphstab::cli {
namespace {

constexpr std::array<std::string_view, 5> formats{"text", "json", "csv", "markdown", "latex"};

/// Prints a result in the format asked for: `describe` makes the text for people, `rows`, if any, the rows of a table.
void print(const Json& answer, const std::string& format, std::string (*describe)(const Json&),
           Json (*rows)(const Json&)) {
  if (format == "text")
    std::cout << describe(answer);
  else
    std::cout << io::write(format == "json" || rows == nullptr ? answer : rows(answer),
                           from_name<io::Format>("format", format));
}

void add_format(CLI::App& app, std::string& format) {
  app.add_option("--format", format, "text, json, csv, markdown or latex [text]")->type_name("");
}

void check_format(const std::string& format) {
  if (std::find(formats.begin(), formats.end(), format) == formats.end()) throw unknown_word("format", format, formats);
}

/// Where the results of a command go, and what besides the answer is wanted.
struct Output {
  std::string format = "text";
  std::optional<std::string> figure;
  std::optional<std::string> folder;
  bool overwrite = false;
  bool explain = false;

  void add_figure_to(CLI::App& app) {
    app.add_option("--figure", figure, "SVG file for a figure of the result")->type_name("FILE");
    app.add_flag("--overwrite", overwrite, "replace the figure if it exists");
  }

  void add_folder_to(CLI::App& app) {
    app.add_option("--output", folder, "folder for the states, figures and tables of the result")->type_name("FOLDER");
    app.add_flag("--overwrite", overwrite, "replace files that are in the folder");
  }

  void check(const CaseCommand& command) const {
    if (overwrite && !figure && !folder)
      throw InvalidInput(fmt::format("overwrite: needs {}", command.has_files ? "--output" : "--figure"));
    if (figure && !figure->ends_with(".svg"))
      throw InvalidInput(fmt::format("figure: '{}' does not end on .svg", *figure));
  }

  io::Existing existing() const { return overwrite ? io::Existing::replace : io::Existing::refuse; }
};

int run_case_command(const CaseCommand& command, const Case& input, const Output& output) {
  check_format(output.format);
  output.check(command);
  if (output.figure) io::write_file(*output.figure, command.figure(input), output.existing());
  std::optional<io::OutputFolder> folder;
  if (output.folder) {
    folder.emplace(*output.folder, output.existing());
    note_signals();  // an interrupted command takes its unfinished folder away
  }
  Json answer = [&] {
    io::Progress bar{std::string(command.name)};
    const auto progress = [&](double fraction) {
      if (signal_received() != 0) throw Interruption{signal_received()};
      bar.show(fraction);
    };
    return command.answer(input, {.progress = progress, .folder = folder ? &*folder : nullptr});
  }();
  if (folder) folder->commit();
  if (output.explain) answer["explanation"] = command.explain(input);
  print(answer, output.format, command.describe, command.rows);
  return command.status == nullptr ? ExitStatus::done : command.status(answer);
}

/// What the subcommands store while the command line is read, and do once it has been.
struct Action {
  CLI::App* app;
  std::function<int()> run;
};

class Program {
 public:
  Program() {
    app_.allow_extras();
    app_.set_version_flag("--version", "sphstab " SPHSTAB_VERSION);
    for (const CaseCommand& command : case_commands())
      if (command.describe != nullptr) add_case_command(command);
    add_table();
    add_batch();
    add_list();
    add_report();
  }

  int run(int argc, char** argv) {
    try {
      app_.parse(argc, argv);
    } catch (const CLI::Success& success) {
      return app_.exit(success);
    } catch (const CLI::ArgumentMismatch& error) {
      const std::string_view message = error.what();
      throw InvalidInput(std::string(message.substr(0, message.find(':'))) + ": takes exactly one value");
    } catch (const CLI::ParseError& error) {
      throw InvalidInput(error.what());
    }
    refuse_rest(app_, "command", command_names());
    for (const Action& action : actions_)
      if (action.app->parsed()) {
        refuse_other_keys(*action.app);
        refuse_rest(*action.app, "option", option_names(*action.app));
        return action.run();
      }
    std::cerr << app_.help();
    throw InvalidInput("command: missing");
  }

 private:
  CLI::App* add(std::string_view name, std::string_view summary) {
    CLI::App* app = app_.add_subcommand(std::string(name), std::string(summary));
    app->allow_extras();
    return app;
  }

  void add_case_command(const CaseCommand& command) {
    CLI::App* app = add(command.name, command.summary);
    auto options = std::make_shared<CaseOptions>();
    options->add_to(*app, command.groups);
    add_format(*app, output_.format);
    if (command.explain != nullptr)
      app->add_flag("--explain", output_.explain, "lead from the scheme to the result, line by line");
    if (command.figure != nullptr) output_.add_figure_to(*app);
    if (command.has_files) output_.add_folder_to(*app);
    actions_.push_back({app, [this, command, options] { return run_case_command(command, options->read(), output_); }});
  }

  void add_table() {
    CLI::App* app = add("table", "a stability table: a sweep over any keys, one row a case");
    auto options = std::make_shared<TableOptions>();
    options->add_to(*app);
    add_format(*app, output_.format);
    actions_.push_back({app, [this, options] {
                          check_format(output_.format);
                          return run_table(*options, output_.format);
                        }});
  }

  void add_batch() {
    CLI::App* app = add("batch", "one JSON case a line in, one JSON result a line out");
    app->add_option("file", argument_, "JSON lines; default: standard input")->type_name("");
    actions_.push_back({app, [this] { return run_batch(argument_); }});
  }

  void add_list() {
    CLI::App* app = add("list", "the names and parameters of kernels, lattices, schemes, integrators, scenes and keys");
    app->add_option("topic", argument_, "one of them; default: all")->type_name("");
    add_format(*app, output_.format);
    actions_.push_back({app, [this] {
                          check_format(output_.format);
                          print(list_answer(argument_), output_.format, describe_list, list_rows);
                          return static_cast<int>(ExitStatus::done);
                        }});
  }

  void add_report() {
    CLI::App* app = add("report", "regenerate a report: table, data and figure in a folder of reports");
    auto options = std::make_shared<ReportOptions>();
    app->add_option("name", options->name,
                    fmt::format("one of {} [zhang-plate]", fmt::join(study::report_names(), ", ")))
        ->type_name("");
    app->add_option("--output", options->output, "folder of reports [reports]")->type_name("FOLDER");
    app->add_flag("--overwrite", options->overwrite, "replace a report that exists");
    app->add_flag("--check", options->check,
                  "write nothing; exit with status 1 if a claim of the report does not hold");
    actions_.push_back({app, [options] { return run_report(*options); }});
  }

  std::vector<std::string> command_names() const {
    std::vector<std::string> names;
    for (const Action& action : actions_) names.push_back(action.app->get_name());
    return names;
  }

  static std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
      if (option->nonpositional()) names.push_back("--" + option->get_lnames().front());
    return names;
  }

  /// Keys of other commands: which of this one is spelled like them says nothing.
  static void refuse_other_keys(const CLI::App& app) {
    for (const std::string& given : app.remaining())
      for (const Key& key : key_table())
        if (const std::string flag = flag_name(key.name); given.substr(0, given.find('=')) == flag)
          throw InvalidInput(fmt::format("option: '{}' is not for {}; --help lists its options", flag, app.get_name()));
  }

  static void refuse_rest(const CLI::App& app, std::string_view what, const std::vector<std::string>& names) {
    const auto rest = app.remaining();
    if (rest.empty()) return;
    const std::vector<std::string_view> allowed(names.begin(), names.end());
    throw unknown_word(what, rest.front().substr(0, rest.front().find('=')), allowed);
  }

  CLI::App app_{
      "Which time step is safe for elastic solids in SPH, and what is not: theory, and a solver that proves it."};
  std::vector<Action> actions_;
  Output output_;
  std::string argument_;
};

}  // namespace

std::span<const CaseCommand> case_commands() {
  static const std::array<CaseCommand, 9> commands{
      dt_command(),
      matrix_command(),
      dispersion_command(),
      growth_command(),
      bisect_command(),
      spectrum_command(),
      run_command(),
      CaseCommand{"kernel",
                  "a kernel and its derivatives at a distance",
                  {KeyGroup::discretisation, KeyGroup::distance},
                  study::kernel_answer,
                  nullptr},
      CaseCommand{"sums",
                  "Gray's lattice sums at a wave vector",
                  {KeyGroup::discretisation, KeyGroup::mode, KeyGroup::artificial_stress},
                  study::sums_answer,
                  nullptr}};
  return commands;
}

const CaseCommand& find_case_command(std::string_view what, std::string_view name) {
  std::vector<std::string_view> names;
  for (const CaseCommand& command : case_commands()) {
    if (command.name == name) return command;
    names.push_back(command.name);
  }
  throw unknown_word(what, name, names);
}

}  // namespace sphstab::cli

int main(int argc, char** argv) {
  using namespace sphstab;
  try {
    const int status = cli::Program().run(argc, argv);
    if (!std::cout.flush()) throw InvalidInput("standard output: cannot be written");
    return status;
  } catch (const InvalidInput& error) {
    std::cerr << "sphstab: " << error.what() << "\n";
    return cli::ExitStatus::bad_input;
  } catch (const cli::Interruption& interruption) {
    std::cerr << "sphstab: interrupted, nothing was written\n";
    return cli::exit_status_of(interruption.signal);
  } catch (const std::exception& error) {
    std::cerr << "sphstab: internal fault: " << error.what() << "\n";
    return cli::ExitStatus::internal_fault;
  }
}

// SPDX-License-Identifier: MIT
#include "cli/case_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "io/case_input.hpp"
#include "io/toml.hpp"

namespace sphstab::cli {
std::string flag_name(std::string_view key) {
  std::string flag = "--" + std::string(key);
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

namespace {

std::string_view group_title(KeyGroup group) {
  switch (group) {
    case KeyGroup::discretisation:
      return "Discretisation";
    case KeyGroup::material:
      return "Material";
    case KeyGroup::scheme:
    case KeyGroup::artificial_stress:
      return "Scheme and base state";
    case KeyGroup::mode:
      return "Mode";
    case KeyGroup::path:
      return "Path and grid";
    case KeyGroup::time:
    case KeyGroup::growth:
      return "Time step";
    case KeyGroup::body:
    case KeyGroup::noise:
      return "Body";
    case KeyGroup::search:
      return "Search";
    case KeyGroup::spectrum:
      return "Spectrum";
    case KeyGroup::run:
      return "Run";
    case KeyGroup::distance:
      return "Query";
  }
  return "";
}

std::string help_text(const Key& key) {
  std::string text(key.help);
  if (!key.words.empty()) text += fmt::format(": {}", fmt::join(key.words, ", "));
  if (!key.default_value.empty()) text += fmt::format(" [{}]", key.default_value);
  return text;
}

}  // namespace

void CaseOptions::add_to(CLI::App& app, const std::vector<KeyGroup>& groups) {
  app.add_option("--case", case_file_, "TOML file with the keys of the case; flags override it")->type_name("FILE");
  for (const Key& key : key_table()) {
    if (std::find(groups.begin(), groups.end(), key.group) == groups.end()) continue;
    options_[&key] = app.add_option(flag_name(key.name), texts_[&key], help_text(key))
                         ->group(std::string(group_title(key.group)))
                         ->type_name("");
  }
}

Json CaseOptions::file() const { return case_file_.empty() ? Json::object() : io::read_toml(case_file_); }

Case CaseOptions::read() const {
  const Json members = file();
  if (members.contains("sweep")) throw InvalidInput("sweep: is read by table only");
  return over(members);
}

Case CaseOptions::over(const Json& members) const {
  Case input;
  io::set_from_json(input, members);
  for (const auto& [key, option] : options_)
    if (option->count() > 0) input.set(key->name, parse_value(*key, texts_.at(key)));
  return input;
}

}  // namespace sphstab::cli

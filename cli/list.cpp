// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <regex>

#include "cli/command.hpp"
#include "io/files.hpp"
#include "model/problem.hpp"

namespace sphstab::cli {
namespace {

constexpr std::array<std::string_view, 6> topics{"kernels", "lattices", "schemes", "integrators", "scenes", "keys"};

/// Where scene files are looked for, below the current folder.
constexpr const char* scene_folder = "scenes";

Json list_kernels() {
  Json rows = Json::array();
  for (const auto& [family, name] : Names<KernelFamily>::table) {
    const Kernel<2> kernel(family, 1.0);
    Json row{{"name", name}, {"support_in_h", kernel.support()}, {"W0_h2_in_2d", kernel.value(0.0)}};
    if (family == KernelFamily::gaussian) row["parameters"] = {"gaussian_cutoff"};
    rows.push_back(std::move(row));
  }
  return rows;
}

template <int Dim>
void add_lattices(Json& rows) {
  for (const LatticeKind kind : lattices_of(Dim)) {
    const Lattice<Dim> lattice(kind, 1.0);
    Json row{{"name", name_of(kind)}, {"dimension", Dim}};
    for (const auto& a : lattice.primitive_vectors().colwise())
      row["primitive_vectors"].push_back(std::vector<double>(a.begin(), a.end()));
    rows.push_back(std::move(row));
  }
}

Json list_lattices() {
  Json rows = Json::array();
  add_lattices<1>(rows);
  add_lattices<2>(rows);
  add_lattices<3>(rows);
  rows.push_back({{"name", name_of(LatticeKind::custom)}, {"parameters", {"primitive_vectors"}}});
  return rows;
}

Json list_integrators() {
  Json rows = Json::array();
  for (const auto& word : find_key("integrator").words) rows.push_back({{"name", word}});
  return rows;
}

/// Whether a key is for this scheme: the help of one that is not for all begins with the names of those it is for.
bool is_read_by(std::string_view scheme, const Key& key) {
  const auto& schemes = find_key("scheme").words;
  const std::string_view beginning = key.help.substr(0, key.help.find(':'));
  bool is_for_all = false, is_named = false;
  for (std::string_view word : split(beginning, ',')) {
    word.remove_prefix(std::min(word.size(), word.find_first_not_of(' ')));
    is_for_all |= std::find(schemes.begin(), schemes.end(), word) == schemes.end();
    is_named |= word == scheme;
  }
  return is_for_all || is_named;
}

/// The schemes and the keys of their materials, terms and base states.
Json list_schemes() {
  constexpr std::array groups{KeyGroup::material, KeyGroup::scheme, KeyGroup::artificial_stress};
  Json rows = Json::array();
  for (const auto& scheme : find_key("scheme").words) {
    Json row{{"name", scheme}};
    for (const Key& key : key_table())
      if (key.name != "scheme" && std::find(groups.begin(), groups.end(), key.group) != groups.end() &&
          is_read_by(scheme, key))
        row["parameters"].push_back(key.name);
    rows.push_back(std::move(row));
  }
  return rows;
}

/// The comment that a scene file begins with, after its licence, up to the end of its first sentence: a full stop that
/// no number follows, as it does in "Sec. 3.1".
std::string description_of(const std::filesystem::path& file) {
  std::string description;
  const std::string text = io::read_file(file);
  for (const auto line : split(text, '\n')) {
    if (!line.starts_with("# ")) break;
    if (line.starts_with("# SPDX")) continue;
    description += (description.empty() ? "" : " ") + std::string(line.substr(2));
  }
  const std::regex end_of_sentence("\\. (?![0-9])");
  std::smatch end;
  return std::regex_search(description, end, end_of_sentence) ? end.prefix().str() : description;
}

Json list_scenes() {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(scene_folder))
    for (const auto& entry : std::filesystem::directory_iterator(scene_folder))
      if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  Json rows = Json::array();
  for (const auto& file : files) rows.push_back({{"name", file.string()}, {"help", description_of(file)}});
  return rows;
}

Json list_keys() {
  Json rows = Json::array();
  for (const Key& key : key_table()) {
    Json row{{"name", key.name}, {"help", key.help}};
    if (!key.default_value.empty()) row["default"] = key.default_value;
    if (!key.words.empty()) row["allowed"] = std::vector<std::string_view>(key.words.begin(), key.words.end());
    rows.push_back(std::move(row));
  }
  return rows;
}

Json list_topic(std::string_view topic) {
  if (topic == "kernels") return list_kernels();
  if (topic == "lattices") return list_lattices();
  if (topic == "schemes") return list_schemes();
  if (topic == "integrators") return list_integrators();
  if (topic == "scenes") return list_scenes();
  return list_keys();
}

}  // namespace

Json list_answer(const std::string& topic) {
  if (!topic.empty() && std::find(topics.begin(), topics.end(), topic) == topics.end())
    throw unknown_word("list", topic, topics);
  Json answer;
  for (const auto name : topics)
    if (topic.empty() || topic == name) answer[std::string(name)] = list_topic(name);
  return answer;
}

Json list_rows(const Json& answer) {
  Json rows = Json::array();
  for (const auto& [topic, names] : answer.items())
    for (const Json& name : names) {
      Json row{{"topic", topic}};
      row.update(name);
      rows.push_back(std::move(row));
    }
  return rows;
}

std::string describe_list(const Json& answer) {
  std::string text;
  for (const auto& [topic, rows] : answer.items()) {
    text += fmt::format("{}:\n", topic);
    for (const Json& entry : rows) {
      text += fmt::format("  {:<28}", entry["name"].get<std::string>());
      for (const auto& [key, value] : entry.items()) {
        if (key == "name") continue;
        const std::string content = value.is_string() ? value.get<std::string>() : value.dump();
        text += fmt::format(" {}: {}", key, content);
      }
      text += '\n';
    }
    text += '\n';
  }
  return text;
}

}  // namespace sphstab::cli

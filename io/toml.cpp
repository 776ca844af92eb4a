// SPDX-License-Identifier: MIT
#include "io/toml.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "io/files.hpp"

namespace sphstab::io {
namespace {

[[noreturn]] void fail(std::string_view name, const toml::source_position& place, std::string_view reason) {
  throw InvalidInput(fmt::format("{}:{}:{}: {}", name, place.line, place.column, reason));
}

Document to_document(const toml::node& node, std::string_view name);

Document to_document(const toml::table& table, std::string_view name) {
  std::vector<std::pair<std::string_view, const toml::node*>> entries;
  for (const auto& [key, value] : table) entries.emplace_back(key.str(), &value);
  std::sort(entries.begin(), entries.end(), [](const auto& left, const auto& right) {
    const auto &l = left.second->source().begin, &r = right.second->source().begin;
    return std::pair(l.line, l.column) < std::pair(r.line, r.column);
  });
  Document document = Document::object();
  for (const auto& [key, value] : entries) document[std::string(key)] = to_document(*value, name);
  return document;
}

Document to_document(const toml::node& node, std::string_view name) {
  switch (node.type()) {
    case toml::node_type::table:
      return to_document(*node.as_table(), name);
    case toml::node_type::array: {
      Document list = Document::array();
      for (const auto& element : *node.as_array()) list.push_back(to_document(element, name));
      return list;
    }
    case toml::node_type::string:
      return node.as_string()->get();
    case toml::node_type::integer:
      return node.as_integer()->get();
    case toml::node_type::floating_point:
      if (!std::isfinite(node.as_floating_point()->get())) fail(name, node.source().begin, "the number is not finite");
      return node.as_floating_point()->get();
    case toml::node_type::boolean:
      return node.as_boolean()->get();
    case toml::node_type::none:
    case toml::node_type::date:
    case toml::node_type::time:
    case toml::node_type::date_time:
      break;
  }
  fail(name, node.source().begin, "a date or time has no meaning in a case");
}

}  // namespace

Document parse_toml(std::string_view text, std::string_view name) {
  try {
    return to_document(toml::parse(text), name);
  } catch (const toml::parse_error& error) {
    fail(name, error.source().begin, error.description());
  }
}

Document read_toml(const std::filesystem::path& path) { return parse_toml(read_file(path), path.string()); }

}  // namespace sphstab::io

// SPDX-License-Identifier: MIT
#include "io/json.hpp"

#include <fmt/format.h>

#include <set>
#include <string>
#include <vector>

namespace sphstab::io {
namespace {

/// No case nests deeper; what walks over a document may recurse.
constexpr int deepest = 32;

/// Refuses keys given twice and deep nesting while the parser goes.
class Inspector {
 public:
  bool operator()(int depth, Document::parse_event_t event, const Document& parsed) {
    using Event = Document::parse_event_t;
    if (depth > deepest) throw InvalidInput(fmt::format("nested deeper than {}", deepest));
    if (event == Event::object_start) keys_.emplace_back();
    if (event == Event::object_end) keys_.pop_back();
    if (event == Event::key && !keys_.back().insert(parsed.get<std::string>()).second)
      throw InvalidInput(fmt::format("{}: given twice", parsed.get<std::string>()));
    return true;
  }

 private:
  std::vector<std::set<std::string>> keys_;  ///< of the objects that are open
};

/// The reason of a message "[json.exception.kind.number] reason".
std::string_view reason(const nlohmann::json::exception& error) {
  const std::string_view message = error.what();
  return message.substr(message.find("] ") + 2);
}

}  // namespace

Document parse_json_line(std::string_view line) {
  try {
    Document document = Document::parse(line, Inspector());
    if (!document.is_object()) throw InvalidInput(fmt::format("{} is no JSON object", document.type_name()));
    return document;
  } catch (const nlohmann::json::exception& error) {
    throw InvalidInput(fmt::format("invalid JSON: {}", reason(error)));
  }
}

}  // namespace sphstab::io

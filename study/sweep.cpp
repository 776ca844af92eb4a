// SPDX-License-Identifier: MIT
#include "study/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <mutex>

#include "io/case_input.hpp"
#include "io/json.hpp"
#include "model/names.hpp"

namespace sphstab::study {
namespace {

/// The values of low:high:count.
std::vector<KeyValue> equally_spaced(const Key& key, std::string_view text) {
  const auto refuse = [&](std::string_view reason) {
    throw InvalidInput(fmt::format("{}: '{}' {}", key.name, text, reason));
  };
  const auto parts = split(text, ':');
  if (parts.size() != 3) refuse("is not low:high:count");
  const auto number = [&](int part) { return std::get<double>(parse_value(key, parts[part])); };
  const double low = number(0), high = number(1), count = number(2);
  if (!(low < high) || !std::isfinite(high - low)) refuse("does not go from a lower to a higher number");
  if (count != std::floor(count) || count < 2.0 || count > largest_sweep)
    refuse(fmt::format("has a count that is no whole number from 2 to {}", largest_sweep));
  const int last = static_cast<int>(count) - 1;
  std::vector<KeyValue> values;
  for (int i = 0; i <= last; ++i) values.emplace_back(std::lerp(low, high, static_cast<double>(i) / last));
  return values;
}

/// Calls visit(label, element) for the elements of an object or a list under every label that they have, until it
/// returns true.
template <class Visit>
bool any_element(const Json& value, const Visit& visit) {
  if (value.is_object()) {
    for (const auto& [name, element] : value.items())
      if (visit(name, element)) return true;
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (visit(std::to_string(i), value[i])) return true;
      if (!value[i].is_object()) continue;
      for (const Json& member : value[i])
        if (member.is_string() && visit(member.get<std::string>(), value[i])) return true;
    }
  }
  return false;
}

/// The result with that flattened name, or nothing.
const Json* find_result(const Json& value, std::string_view name) {
  const Json* found = nullptr;
  any_element(value, [&](const std::string& label, const Json& element) {
    if (!name.starts_with(label)) return false;
    if (name.size() == label.size())
      found = &element;
    else if (name[label.size()] == '.')
      found = find_result(element, name.substr(label.size() + 1));
    return found != nullptr;
  });
  return found;
}

/// The flattened names of all results that are neither objects nor lists of objects, the elements of such lists by
/// their first text.
void add_names(const Json& value, const std::string& prefix, std::vector<std::string>& names) {
  for (const auto& [key, member] : value.items()) {
    const auto named = [](const Json& element) { return element.is_string(); };
    const bool list_of_objects = member.is_array() && !member.empty() && member.front().is_object();
    if (member.is_object()) add_names(member, prefix + key + ".", names);
    if (!member.is_structured() || (member.is_array() && !list_of_objects)) names.push_back(prefix + key);
    if (!list_of_objects) continue;
    for (std::size_t i = 0; i < member.size(); ++i) {
      const auto text = std::find_if(member[i].begin(), member[i].end(), named);
      const std::string label = text == member[i].end() ? std::to_string(i) : text->get<std::string>();
      add_names(member[i], prefix + key + "." + label + ".", names);
    }
  }
}

Request request_of(const Question& question) {
  Request request;
  for (const auto& column : question.columns) request.results.push_back(column.substr(0, column.find('.')));
  return request;
}

/// The columns that the answer has.
Json chosen(const Json& answer, const std::vector<std::string>& columns) {
  Json results = Json::object();
  for (const auto& column : columns)
    if (const Json* found = find_result(answer, column)) results[column] = *found;
  if (columns.empty())
    for (const auto& [key, value] : answer.items())
      if (!value.is_structured()) results[key] = value;
  return results;
}

Json answer_row(const Sweep& sweep, long index, const Question& question, const Request& request) {
  Json row{{"case", index}};
  try {
    row["results"] = chosen(question.answer(case_of(sweep, index), request), question.columns);
  } catch (const std::exception& error) {
    row["error"] = error.what();
  }
  // Through its line of text, so that a row worked out is the row that a later run takes over.
  return io::parse_json_line(io::to_json_line(row));
}

[[noreturn]] void throw_unknown_column(const std::string& column, const Sweep& sweep, const Question& question,
                                       const SweepRows& done) {
  const auto good =
      std::find_if(done.rows.begin(), done.rows.end(), [](const Json& row) { return row.contains("results"); });
  std::vector<std::string> names;
  add_names(question.answer(case_of(sweep, good - done.rows.begin()), {}), "", names);
  const std::vector<std::string_view> views(names.begin(), names.end());
  throw unknown_word("columns", column, views);
}

/// The columns of the table: those asked for, or all that are in any row.
std::vector<std::string> columns_of(const Question& question, const SweepRows& done) {
  if (!question.columns.empty()) return question.columns;
  std::vector<std::string> columns;
  for (const Json& row : done.rows)
    if (row.contains("results"))
      for (const auto& [name, value] : row["results"].items())
        if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.push_back(name);
  return columns;
}

}  // namespace

SweptKey parse_swept_key(std::string_view text) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos) throw InvalidInput(fmt::format("sweep: '{}' is not KEY=VALUES", text));
  SweptKey swept{std::string(text.substr(0, equals)), {}};
  std::replace(swept.key.begin(), swept.key.end(), '-', '_');
  const Key& key = find_key(swept.key);
  text.remove_prefix(equals + 1);
  const bool number = key.kind == KeyKind::number || key.kind == KeyKind::integer;
  if (number && text.find(':') != std::string_view::npos) return {swept.key, equally_spaced(key, text)};
  const bool list = key.kind == KeyKind::numbers || key.kind == KeyKind::integers;
  for (const auto part : split(text, list ? ';' : ',')) swept.values.push_back(parse_value(key, part));
  return swept;
}

SweptKey swept_key(const std::string& key, const Json& values) {
  find_key(key);  // an unknown key comes before a value of a wrong kind
  if (!values.is_array()) throw InvalidInput(fmt::format("{}: {} is no list of values to sweep", key, values.dump()));
  SweptKey swept{key, {}};
  for (const Json& value : values) swept.values.push_back(io::to_value(key, value));
  return swept;
}

Sweep make_sweep(Case base, std::vector<SweptKey> keys) {
  double size = 1.0;
  for (auto swept = keys.begin(); swept != keys.end(); ++swept) {
    for (const KeyValue& value : swept->values) check_value(find_key(swept->key), value);
    if (swept->values.empty()) throw InvalidInput(fmt::format("{}: has no values to sweep", swept->key));
    if (base.has(swept->key)) throw InvalidInput(fmt::format("{}: is swept and given a value too", swept->key));
    if (std::any_of(keys.begin(), swept, [&](const SweptKey& earlier) { return earlier.key == swept->key; }))
      throw InvalidInput(fmt::format("{}: is swept twice", swept->key));
    size *= static_cast<double>(swept->values.size());
  }
  if (size > largest_sweep) throw InvalidInput(fmt::format("sweep: {:g} cases are more than {}", size, largest_sweep));
  return {std::move(base), std::move(keys)};
}

long sweep_size(const Sweep& sweep) {
  long size = 1;
  for (const SweptKey& swept : sweep.keys) size *= static_cast<long>(swept.values.size());
  return size;
}

Case case_of(const Sweep& sweep, long index) {
  Case input = sweep.base;
  for (auto swept = sweep.keys.rbegin(); swept != sweep.keys.rend(); ++swept) {
    const long count = static_cast<long>(swept->values.size());
    input.set(swept->key, swept->values[index % count]);
    index /= count;
  }
  return input;
}

long SweepRows::errors() const {
  return std::count_if(rows.begin(), rows.end(), [](const Json& row) { return row.contains("error"); });
}

SweepRows run_sweep(const Sweep& sweep, const Question& question, SweepOptions options) {
  const long size = sweep_size(sweep);
  SweepRows done;
  done.rows.resize(size);
  for (Json& row : options.taken_over) {
    Json& place = done.rows.at(row.at("case").get<std::size_t>());
    done.taken_over += place.is_null();
    place = std::move(row);
  }
  const Request request = request_of(question);
  const auto stopped = [&] { return options.stop && options.stop(); };
  std::mutex mutex;
  std::atomic<bool> failed = false;
  const auto work = [&](int index) {
    if (!done.rows[index].is_null() || failed || stopped()) return;
    Json row = answer_row(sweep, index, question, request);
    const std::lock_guard guard(mutex);
    if (failed || (row.contains("error") && stopped())) return;  // what stops the sweep may be what broke the case
    try {
      if (options.finished) options.finished(row);
    } catch (...) {
      failed = true;
      throw;
    }
    done.rows[index] = std::move(row);
    ++done.answered;
    if (options.progress)
      options.progress(static_cast<double>(done.answered + done.taken_over) / static_cast<double>(size));
  };
  parallel_for(static_cast<int>(size), work, options.threads);
  return done;
}

Json table_rows(const Sweep& sweep, const Question& question, const SweepRows& done) {
  if (done.errors() == static_cast<long>(done.rows.size()))
    throw InvalidInput(done.rows.front()["error"].get<std::string>());
  const auto columns = columns_of(question, done);
  for (const auto& column : columns)
    if (std::none_of(done.rows.begin(), done.rows.end(),
                     [&](const Json& row) { return row.contains("results") && row["results"].contains(column); }))
      throw_unknown_column(column, sweep, question, done);
  Json table = Json::array();
  const bool any_error = done.errors() > 0;
  for (std::size_t i = 0; i < done.rows.size(); ++i) {
    const Case input = case_of(sweep, static_cast<long>(i));
    Json row = Json::object();
    for (const SweptKey& swept : sweep.keys) row[swept.key] = io::to_json(input, find_key(swept.key));
    const Json& results = done.rows[i].value("results", Json::object());
    for (const auto& column : columns)
      if (!row.contains(column)) row[column] = results.value(column, Json());
    if (any_error) row["error"] = done.rows[i].value("error", Json());
    table.push_back(std::move(row));
  }
  return table;
}

}  // namespace sphstab::study

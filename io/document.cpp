// SPDX-License-Identifier: MIT
#include "io/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

namespace sphstab::io {
namespace {

using ErrorHandler = nlohmann::detail::error_handler_t;

constexpr const char* every_digit = "{}";

std::string cell_text(const Document& value, const std::string& number_format) {
  if (value.is_null() || (value.is_number_float() && !std::isfinite(value.get<double>()))) return {};
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number() && number_format != every_digit)
    return fmt::format(fmt::runtime(number_format), value.get<double>());
  if (!value.is_array() || std::any_of(value.begin(), value.end(), [](const auto& v) { return v.is_structured(); }))
    return to_json_line(value);
  std::string text;
  for (const auto& element : value) {
    if (!text.empty()) text += ' ';
    text += cell_text(element, number_format);
  }
  return text;
}

using FlatRow = std::vector<std::pair<std::string, Document>>;

void flatten(const Document& object, const std::string& prefix, FlatRow& row) {
  for (const auto& [key, value] : object.items()) {
    if (value.is_object())
      flatten(value, prefix + key + ".", row);
    else
      row.emplace_back(prefix + key, value);
  }
}

FlatRow flat(const Document& object) {
  FlatRow row;
  flatten(object, "", row);
  return row;
}

/// Every key of the rows, in the order of first appearance.
std::vector<Column> all_columns(const Document& rows, const std::string& number_format) {
  std::vector<Column> columns;
  for (const auto& row : rows)
    for (const auto& [key, value] : flat(row))
      if (std::none_of(columns.begin(), columns.end(), [&name = key](const Column& c) { return c.key == name; }))
        columns.push_back({key, key, number_format});
  return columns;
}

std::string cell(const FlatRow& row, const Column& column) {
  const auto found = std::find_if(row.begin(), row.end(), [&](const auto& entry) { return entry.first == column.key; });
  return found == row.end() ? std::string() : cell_text(found->second, column.number_format);
}

Table case_per_row(const Document& document) {
  return to_table(document.is_array() ? document : Document::array({document}), every_digit);
}

Table key_per_row(const Document& document) {
  if (document.is_array()) return case_per_row(document);
  Table table{{"key", "value"}, {}};
  for (const auto& [key, value] : flat(document)) table.rows.push_back({key, cell_text(value, every_digit)});
  return table;
}

bool is_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// Whether a column holds numbers and empty cells only, and at least one number.
bool is_numeric(const Table& table, std::size_t column) {
  bool any = false;
  for (const auto& row : table.rows) {
    if (row[column].empty()) continue;
    if (!is_number(row[column])) return false;
    any = true;
  }
  return any;
}

/// One line a row: `begin`, the cells through `escape` with `separator` between them, `end`.
template <class Escape>
void append_row(std::string& out, const std::vector<std::string>& cells, std::string_view begin,
                std::string_view separator, std::string_view end, const Escape& escape) {
  out += begin;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) out += separator;
    out += escape(cells[i]);
  }
  out += end;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string markdown_cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\n' || c == '\r') {
      escaped += ' ';
      continue;
    }
    if (std::string_view("\\|*<`").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string latex_character(char c) {
  switch (c) {
    case '\\':
      return "\\textbackslash{}";
    case '~':
      return "\\textasciitilde{}";
    case '^':
      return "\\textasciicircum{}";
    case '<':
      return "\\textless{}";
    case '>':
      return "\\textgreater{}";
    case '|':
      return "\\textbar{}";
    case '\n':
    case '\r':
      return " ";
    case '&':
    case '%':
    case '$':
    case '#':
    case '_':
    case '{':
    case '}':
      return {'\\', c};
    default:
      return {c};
  }
}

std::string latex_cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += latex_character(c);
  return escaped;
}

}  // namespace

Table select(const Document& rows, const std::vector<Column>& columns) {
  Table table;
  for (const auto& column : columns) table.header.push_back(column.header);
  for (const auto& object : rows) {
    const FlatRow row = flat(object);
    auto& cells = table.rows.emplace_back();
    for (const auto& column : columns) cells.push_back(cell(row, column));
  }
  return table;
}

Table to_table(const Document& rows, const std::string& number_format) {
  return select(rows, all_columns(rows, number_format));
}

std::string write(const Document& document, Format format) {
  switch (format) {
    case Format::json:
      return document.dump(2, ' ', false, ErrorHandler::replace) + "\n";
    case Format::csv:
      return to_csv(case_per_row(document));
    case Format::markdown:
      return to_markdown(key_per_row(document));
    case Format::latex:
      return to_latex(key_per_row(document));
  }
  return {};
}

std::string to_json_line(const Document& document) { return document.dump(-1, ' ', false, ErrorHandler::replace); }

std::string to_text(const Table& table) {
  std::vector<std::size_t> widths;
  for (std::size_t column = 0; column < table.header.size(); ++column) {
    widths.push_back(table.header[column].size());
    for (const auto& row : table.rows) widths[column] = std::max(widths[column], row[column].size());
  }
  std::vector<bool> numeric;
  for (std::size_t column = 0; column < widths.size(); ++column) numeric.push_back(is_numeric(table, column));
  std::string out;
  const auto append = [&](const std::vector<std::string>& cells) {
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string padding(widths[i] - cells[i].size(), ' ');
      line += (numeric[i] ? padding + cells[i] : cells[i] + padding) + "  ";
    }
    out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  };
  append(table.header);
  for (const auto& row : table.rows) append(row);
  return out;
}

std::string to_csv(const Table& table) {
  std::string out;
  append_row(out, table.header, "", ",", "\n", csv_cell);
  for (const auto& row : table.rows) append_row(out, row, "", ",", "\n", csv_cell);
  return out;
}

std::string to_markdown(const Table& table) {
  std::string out;
  append_row(out, table.header, "| ", " | ", " |\n", markdown_cell);
  for (std::size_t column = 0; column < table.header.size(); ++column)
    out += is_numeric(table, column) ? "|---:" : "|---";
  out += "|\n";
  for (const auto& row : table.rows) append_row(out, row, "| ", " | ", " |\n", markdown_cell);
  return out;
}

std::string to_latex(const Table& table) {
  std::string out = "\\begin{tabular}{";
  for (std::size_t column = 0; column < table.header.size(); ++column) out += is_numeric(table, column) ? 'r' : 'l';
  out += "}\n\\hline\n";
  append_row(out, table.header, "", " & ", " \\\\\n", latex_cell);
  out += "\\hline\n";
  for (const auto& row : table.rows) append_row(out, row, "", " & ", " \\\\\n", latex_cell);
  return out + "\\hline\n\\end{tabular}\n";
}

}  // namespace sphstab::io

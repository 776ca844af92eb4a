// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "model/names.hpp"

namespace sphstab {
namespace io {

/// A case or a result: keys in the order in which they were written.
using Document = nlohmann::ordered_json;

/// The formats for programs and papers; the text for people is the command line's own.
enum class Format { json, csv, markdown, latex };

/// Cells as they are printed, escaped by the writer of each format. Every row has as many cells as the header.
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// A column chosen from rows: the flattened key (`critical_mode.branch`), the header above it and, for numbers, a fmt
/// format such as "{:.4f}"; "{}" keeps every digit.
struct Column {
  std::string key;
  std::string header;
  std::string number_format = "{}";
};

/// The chosen columns of an array of rows. A row without the key, or with null there, has an empty cell.
Table select(const Document& rows, const std::vector<Column>& columns);

/// Every flattened key of an array of objects, in the order of first appearance, with numbers in one format, in lists
/// too.
Table to_table(const Document& rows, const std::string& number_format = "{}");

/// `document`, an object or an array of objects, in `format`, ending in a newline. In tables nested objects are
/// flattened with dots, a list of plain values is separated by spaces, any deeper list is compact JSON, null is an
/// empty cell. An array has one row an object, under the keys of all of them; a single object has one row in CSV, and
/// one row a key in Markdown and LaTeX. Doubles keep every digit; those that are not finite become null.
std::string write(const Document& document, Format format);

/// The document on one line, without newline. Bytes that are no UTF-8 are replaced.
std::string to_json_line(const Document& document);

/// Aligned columns for people, two spaces apart; columns of numbers are aligned to the right.
std::string to_text(const Table& table);
/// RFC 4180 with newlines of one byte.
std::string to_csv(const Table& table);
/// A GitHub table; columns of numbers are aligned to the right.
std::string to_markdown(const Table& table);
/// A plain tabular environment that needs no package; columns of numbers are aligned to the right.
std::string to_latex(const Table& table);

}  // namespace io

template <>
struct Names<io::Format> {
  static constexpr std::array<Named<io::Format>, 4> table{{{io::Format::json, "json"},
                                                           {io::Format::csv, "csv"},
                                                           {io::Format::markdown, "markdown"},
                                                           {io::Format::latex, "latex"}}};
};

}  // namespace sphstab

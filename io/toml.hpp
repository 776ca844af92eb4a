// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

#include "io/document.hpp"

namespace sphstab::io {

/// The tables, arrays, strings, numbers and booleans of a TOML text, keys in the order of the text. `name` stands for
/// the file in messages. Throws InvalidInput "name:line:column: reason", in one line, on a syntax error, a date or
/// time, or a number that is not finite.
Document parse_toml(std::string_view text, std::string_view name);

/// parse_toml of a file. Throws InvalidInput also where the file cannot be read.
Document read_toml(const std::filesystem::path& path);

}  // namespace sphstab::io

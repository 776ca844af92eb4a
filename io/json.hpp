// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "io/document.hpp"

namespace sphstab::io {

/// The JSON object on one line. Throws InvalidInput, in one line with the column, on a syntax error, a key given twice,
/// a number beyond the range of a double, or a value that is no object.
Document parse_json_line(std::string_view line);

}  // namespace sphstab::io

// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <string>
#include <string_view>

#include "study/answers.hpp"

namespace sphstab::cli {

/// One line of a result for people: a name and what it is.
std::string row(std::string_view name, std::string_view content);

/// The numbers of a list with so many significant digits, separated by commas.
std::string numbers(const study::Json& list, int digits);

/// A number with so many digits, or `otherwise` for null.
std::string number_or(const study::Json& number, std::string_view otherwise, int digits = 12);

/// A complex number with so many digits of each part; a real one without the imaginary part.
std::string complex_number(std::complex<double> value, int digits);

/// The number of a pair [re, im].
std::complex<double> complex_of(const study::Json& pair);

/// The line on ellipticity of an answer about finite strain; nothing for others.
std::string ellipticity_row(const study::Json& answer);

/// The body that an answer is of, in words.
std::string subject(const study::Json& answer);

}  // namespace sphstab::cli

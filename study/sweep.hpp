// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "study/parallel.hpp"
#include "study/request.hpp"

namespace sphstab::study {

/// A key of a sweep and the values that it takes, one after the other.
struct SweptKey {
  std::string key;
  std::vector<KeyValue> values;
};

/// A case in which some keys change: every combination of their values is a case of its own. The first key runs
/// slowest, the last one fastest.
struct Sweep {
  Case base;
  std::vector<SweptKey> keys;
};

/// No sweep has more cases.
constexpr long largest_sweep = 10000000;

/// "KEY=VALUES" of the command line, dashes in the key as good as underscores. VALUES are separated by commas, those of
/// keys that are lists by semicolons; `low:high:count` stands for count equally spaced numbers, both ends included
/// exactly. Throws InvalidInput naming the key.
SweptKey parse_swept_key(std::string_view text);

/// A member of the table `[sweep]` of a case file: an array of values. Throws InvalidInput naming the key.
SweptKey swept_key(const std::string& key, const Json& values);

/// The sweep of these keys. Throws InvalidInput naming the key where a value is not one the key allows, the key has no
/// values, is swept twice or is in `base` too, or where there are more than largest_sweep cases.
Sweep make_sweep(Case base, std::vector<SweptKey> keys);

/// The product of the numbers of values.
long sweep_size(const Sweep& sweep);

/// The case of that number, 0 … sweep_size − 1.
Case case_of(const Sweep& sweep, long index);

/// What a sweep asks each of its cases: a command, and the results that are wanted from it, by their flattened names.
/// A name is read from left to right. In an object it goes on with the name of a member; in a list with a number from 0
/// (`bracket.1`) or with the text of any member of an element (`equivalents.Radioss SPH cell step.factor_at_limit`).
struct Question {
  std::function<Json(const Case&, const Request&)> answer;
  std::vector<std::string> columns;  ///< empty: every result that is no object and no list
};

struct SweepOptions {
  int threads = all_cores();
  /// Rows that an interrupted run of the same sweep finished, as `finished` was given them.
  std::vector<Json> taken_over = {};
  /// Told of each row that was worked out, in any order but one at a time: {"case", "results" or "error"}.
  std::function<void(const Json& row)> finished = nullptr;
  /// No case is begun once it says so.
  std::function<bool()> stop = nullptr;
  Progress progress = nullptr;
};

/// What became of the cases of a sweep, in their order. A row that no one asked for because of `stop` is null.
struct SweepRows {
  std::vector<Json> rows;
  long answered = 0;    ///< cases worked out here, those with an error among them
  long taken_over = 0;  ///< rows of the interrupted run

  bool complete() const { return answered + taken_over == static_cast<long>(rows.size()); }
  long errors() const;
};

/// Answers every case of the sweep on all cores. Of an answer only the columns are kept, and only what they need is
/// worked out (Request::results). A case that fails has its message in place of results and stops no other. The rows
/// are the same whatever the number of threads and wherever they were interrupted. tests/study/test_sweep.cpp.
SweepRows run_sweep(const Sweep& sweep, const Question& question, SweepOptions options = {});

/// The rows of a complete sweep for printing: an array of objects with the swept keys, then the columns, null where a
/// result is absent, then, if any case failed, `error`. Throws InvalidInput if every case failed, with the error of the
/// first, and if a column is in no row, with the names that there are.
Json table_rows(const Sweep& sweep, const Question& question, const SweepRows& done);

}  // namespace sphstab::study

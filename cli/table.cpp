// SPDX-License-Identifier: MIT
#include "cli/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <utility>

#include "cli/interruption.hpp"
#include "io/case_input.hpp"
#include "io/files.hpp"
#include "io/json.hpp"
#include "io/progress.hpp"
#include "model/names.hpp"
#include "study/sweep.hpp"

namespace sphstab::cli {
namespace {

using Clock = std::chrono::steady_clock;

std::vector<std::string> columns_of(const std::string& text) {
  const auto names = split(text, ',');
  return {names.begin(), names.end()};
}

/// The keys of `[sweep]` in the case file and those of --sweep, which replace the same key of the file in its place.
std::vector<study::SweptKey> swept_keys(const Json& table, const std::vector<std::string>& flags) {
  if (!table.is_object()) throw InvalidInput("sweep: is not a table of keys and lists of values");
  std::vector<study::SweptKey> keys;
  for (const auto& [key, values] : table.items()) keys.push_back(study::swept_key(key, values));
  const auto from_file = static_cast<std::ptrdiff_t>(keys.size());
  for (const auto& flag : flags) {
    study::SweptKey swept = study::parse_swept_key(flag);
    const auto end = keys.begin() + from_file;
    const auto same = std::find_if(keys.begin(), end, [&](const study::SweptKey& key) { return key.key == swept.key; });
    if (same == end)
      keys.push_back(std::move(swept));
    else
      *same = std::move(swept);
  }
  if (keys.empty()) throw InvalidInput("sweep: missing (KEY=VALUES)");
  return keys;
}

study::Sweep read_sweep(const TableOptions& options, const CaseCommand& command) {
  Json members = options.base.file();
  const Json table = members.value("sweep", Json::object());
  members.erase("sweep");
  study::Sweep sweep = study::make_sweep(options.base.over(members), swept_keys(table, options.sweep));
  for (const auto& swept : sweep.keys)
    if (const auto& groups = command.groups;
        std::find(groups.begin(), groups.end(), find_key(swept.key).group) == groups.end())
      throw InvalidInput(fmt::format("{}: is not read by {}", swept.key, command.name));
  return sweep;
}

/// The first line of the journal: all that the rows depend on.
std::string identity(const study::Sweep& sweep, std::string_view answer, const std::vector<std::string>& columns) {
  Json base = Json::object(), keys = Json::object();
  for (const Key& key : key_table())
    if (sweep.base.has(key.name)) base[std::string(key.name)] = io::to_json(sweep.base, key);
  for (const auto& swept : sweep.keys)
    for (const KeyValue& value : swept.values) {
      Case one;
      one.set(swept.key, value);
      keys[swept.key].push_back(io::to_json(one, find_key(swept.key)));
    }
  return io::to_json_line({{"sphstab", SPHSTAB_VERSION},
                           {"answer", answer},
                           {"base", std::move(base)},
                           {"sweep", std::move(keys)},
                           {"columns", columns}});
}

/// The rows in the journal; a line that is none was not written to its end.
std::vector<Json> rows_of(const io::Journal& journal) {
  std::vector<Json> rows;
  for (const auto& line : journal.lines()) try {
      rows.push_back(io::parse_json_line(line));
    } catch (const InvalidInput&) {
    }
  return rows;
}

std::string text_of(const Json& rows, const std::string& format) {
  constexpr const char* readable = "{:.8g}";
  if (format == "text") return io::to_text(io::to_table(rows, readable));
  switch (from_name<io::Format>("format", format)) {
    case io::Format::json:
      return io::write({{"rows", rows}}, io::Format::json);
    case io::Format::csv:
      return io::to_csv(io::to_table(rows));
    case io::Format::markdown:
      return io::to_markdown(io::to_table(rows, readable));
    case io::Format::latex:
      return io::to_latex(io::to_table(rows, readable));
  }
  return {};
}

void warn_of_errors(const study::SweepRows& done) {
  if (const long errors = done.errors(); errors > 0)
    std::cerr << fmt::format("sphstab: warning: {} of {} cases failed, see the column error\n", errors,
                             done.rows.size());
}

study::SweepRows run_with_bar(const study::Sweep& sweep, const study::Question& question, study::SweepOptions options) {
  io::Progress bar{"table"};
  options.progress = [&](double fraction) { bar.show(fraction); };
  return study::run_sweep(sweep, question, std::move(options));
}

/// The rows for printing. Where there is no table to be had the journal goes too: it would stand in the way of a better
/// question.
Json rows_or_no_journal(const study::Sweep& sweep, const study::Question& question, const study::SweepRows& done,
                        io::Journal& journal) {
  try {
    return study::table_rows(sweep, question, done);
  } catch (const InvalidInput&) {
    journal.remove();
    throw;
  }
}

int write_table(const study::Sweep& sweep, const study::Question& question, std::string_view answer,
                const TableOptions& options, const std::string& format) {
  const auto start = Clock::now();
  const auto existing = options.overwrite ? io::Existing::replace : io::Existing::refuse;
  io::check_output(*options.output, existing);
  io::Journal journal(*options.output + ".journal", identity(sweep, answer, question.columns), existing);
  note_signals();
  const study::SweepRows done =
      run_with_bar(sweep, question,
                   {.taken_over = rows_of(journal),
                    .finished = [&](const Json& row) { journal.append(io::to_json_line(row)); },
                    .stop = [] { return signal_received() != 0; }});
  if (!done.complete()) {
    std::cerr << fmt::format("sphstab: interrupted: {} of {} rows are done; the same command goes on from there\n",
                             done.answered + done.taken_over, done.rows.size());
    return exit_status_of(signal_received());
  }
  io::write_file(*options.output, text_of(rows_or_no_journal(sweep, question, done, journal), format), existing);
  journal.remove();
  warn_of_errors(done);
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  std::cerr << fmt::format("sphstab: {}: {} rows, {} of them taken over, {} errors, {:.2f} s, {:.3g} ms a case\n",
                           *options.output, done.rows.size(), done.taken_over, done.errors(), seconds,
                           1e3 * seconds / static_cast<double>(std::max(done.answered, 1L)));
  return ExitStatus::done;
}

}  // namespace

void TableOptions::add_to(CLI::App& app) {
  app.add_option("--sweep", sweep, "KEY=VALUES: a,b,c or low:high:count; may be repeated, the first runs slowest")
      ->type_name("")
      ->allow_extra_args(false);
  app.add_option("--answer", answer, "the command that answers each case [dt]")->type_name("");
  app.add_option("--columns", columns, "the results shown, separated by commas")->type_name("");
  app.add_option("--output", output, "file for the table, with a journal to go on from after an interruption")
      ->type_name("FILE");
  app.add_flag("--overwrite", overwrite, "replace a file that exists, and a journal of another sweep");
  base.add_to(app, {KeyGroup::discretisation, KeyGroup::material, KeyGroup::scheme, KeyGroup::artificial_stress,
                    KeyGroup::mode, KeyGroup::path, KeyGroup::time, KeyGroup::growth, KeyGroup::body,
                    KeyGroup::spectrum, KeyGroup::run, KeyGroup::noise, KeyGroup::search, KeyGroup::distance});
}

int run_table(const TableOptions& options, const std::string& format) {
  if (options.overwrite && !options.output) throw InvalidInput("overwrite: needs --output");
  if (options.output && options.output->empty()) throw InvalidInput("output: is empty, not the name of a file");
  const CaseCommand& command = find_case_command("answer", options.answer);
  const study::Question question{command.answer,
                                 options.columns.empty() ? command.columns : columns_of(options.columns)};
  const study::Sweep sweep = read_sweep(options, command);
  if (options.output) return write_table(sweep, question, command.name, options, format);
  const study::SweepRows done = run_with_bar(sweep, question, {});
  std::cout << text_of(study::table_rows(sweep, question, done), format);
  warn_of_errors(done);
  return ExitStatus::done;
}

}  // namespace sphstab::cli

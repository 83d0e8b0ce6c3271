// run.cpp — common options, exit statuses, main().
#include "cli/run.hpp"
#include "base/memory.hpp"
#include "base/settle_heap.hpp"
#include "cli/cleanup.hpp"
#include "cli/cpus.hpp"
#include "cli/file_kind.hpp"
#include "cli/report.hpp"
#include "cli/text.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <new>
#include <stdexcept>
#include <sys/resource.h>

#ifndef MOLMESH_VERSION
#define MOLMESH_VERSION "0.0.0"
#endif

namespace molmesh::cli {

int Common::resolved_threads() const {
  if (on_device()) {
    if (!require_device)
      fail(Status::mode_unavailable, "--mode cuda: this program has none, use seq or omp");
    require_device();
  }
  if (mode == "seq")
    return 1;
  if (threads > 1 && !par::has_threads())
    fail(Status::mode_unavailable, "-t: found " + std::to_string(threads) + ", expected 1: built without OpenMP");
  return threads > 0 ? threads : default_threads();
}

void Run::phase(const std::string& name) {
  end_phase();
  open_ = static_cast<size_t>(
      std::find_if(phases.begin(), phases.end(), [&](const Phase& p) { return p.name == name; }) - phases.begin());
  if (open_ == phases.size())
    phases.push_back({name, 0});
  started_ = std::chrono::steady_clock::now();
  if (line_)
    line_->phase(name);
}

void Run::end_phase() {
  if (open_ == none)
    return;
  phases[open_].seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  open_ = none;
}

void Run::show_phases(std::vector<ForeseenPhase> foreseen) {
  line_ = std::make_unique<PhaseLine>(tool, quiet);
  line_->foresee(std::move(foreseen));
  if (open_ != none)
    line_->phase(phases[open_].name);
}

void Run::note(const std::string& line) const {
  if (line_)
    line_->clear();
  if (!quiet)
    std::cerr << tool << ": " << one_line(line) << '\n';
}

std::string version() {
  return MOLMESH_VERSION;
}

std::string creator(const std::string& tool) {
  return tool + " " + version();
}

namespace {

void describe_common(Table& table, Common& o) {
  table.add("input", o.input, "input file; - is standard input").not_reported();
  table.add("-o,--output", o.output, "output file; - is standard output").unit("FILE").not_reported();
  table
      .add("--mode", o.mode,
           "seq: one thread, omp: many cores, cuda: one GPU, auto: omp, or cuda if it makes the same bytes sooner")
      .unit("MODE")
      .one_of({"auto", "seq", "omp", "cuda"});
  table.add("-t,--threads", o.threads, "threads for --mode omp; 0: all that are granted").within(0, 1024);
  table.add("--report", o.report, "write the run report (JSON) to this file").unit("FILE").not_reported();
  table.add("-q,--quiet", o.quiet, "errors only on standard error").not_reported();
  table.add("-v,--verbose", o.verbose, "phases and their seconds on standard error").not_reported();
}

int finish(const Table& table, const Common& o, Run& run, OutputFile* report, Status status) {
  run.end_phase();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const int64_t peak = peak_memory(), peak_rss_bytes = peak < 0 ? int64_t{usage.ru_maxrss} * 1024 : peak;
  if (run.verbose) {
    for (const Run::Phase& p : run.phases)
      std::fprintf(stderr, "%s: %-16s %8.3f s\n", run.tool.c_str(), p.name.c_str(), p.seconds);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    std::fprintf(stderr, "%s: %.3f s of processor time, %.1f MB at most\n", run.tool.c_str(),
                 seconds(usage.ru_utime) + seconds(usage.ru_stime), 1e-6 * double(peak_rss_bytes));
  }
  if (report) {
    report->stream() << report_text(table, o, run, peak_rss_bytes);
    run.complete(*report);
  }
  std::for_each(run.outputs.rbegin(), run.outputs.rend(), [](CompleteFile& file) { file.publish(); });
  if (!run.made.empty()) {
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.2f s", run.seconds());
    std::string files;
    for (const std::string& file : o.outputs())
      if (files.empty() || o.shows_every_output)
        files += (files.empty() ? "" : ", ") + (file == "-" ? "<stdout>" : file);
    run.note(run.made + "; " + seconds + "; " + files);
  }
  return static_cast<int>(status);
}

/// The message with the program's flags: in front, where the message begins with the quantity's name, else after
/// it.
std::string with_flags(const Error& e, const Table& table) {
  std::string text = e.what(), flags;
  for (const std::string& quantity : e.quantities) {
    const std::string flag = table.flag_of(quantity);
    const bool first = text.rfind(quantity + ':', 0) == 0 || text.rfind(quantity + ' ', 0) == 0;
    if (first && !flag.empty())
      text.replace(0, quantity.size(), flag);
    else if (!flag.empty())
      flags += (flags.empty() ? "" : ", ") + flag;
  }
  return flags.empty() ? text : text + " (" + flags + ")";
}

/// A quantity is out of range, and nobody gave it: by its default, it does not go with the input.
bool blames_input(const Error& e, const Table& table) {
  return e.status == Status::usage && !e.quantities.empty() &&
         std::none_of(table.options.begin(), table.options.end(), [&](const Option& o) {
           return !o.given.empty() && std::count(e.quantities.begin(), e.quantities.end(), o.name) > 0;
         });
}

/// What an option's file holds, by what the program's page says of it.
Kind wanted_kind(const Table& table, const Option& o) {
  const std::string& says = o.name == "input" && !table.page.files.empty() ? table.page.files[0].name : o.meaning;
  constexpr std::array<std::pair<const char*, Kind>, 10> signs = {{{".map", Kind::map},
                                                                   {".pdb", Kind::structure},
                                                                   {".join", Kind::plan},
                                                                   {".hier", Kind::hierarchy},
                                                                   {".vdb", Kind::density},
                                                                   {".vtu", Kind::mesh},
                                                                   {"run report", Kind::report},
                                                                   {"mesh", Kind::mesh},
                                                                   {"density", Kind::density},
                                                                   {"lines", Kind::table}}};
  for (const auto& [sign, kind] : signs)
    if (says.find(sign) != std::string::npos)
      return kind;
  return o.meaning.find("file of ") != std::string::npos ? Kind::table : Kind::unknown;
}

/// "FILE:1: found a hierarchy of atoms (.hier), expected a density grid (.vdb): run hier2density first", where the
/// message is of a file whose kind the program does not read; else the message.
std::string with_kind(const Table& table, const std::string& message) {
  for (const Option& o : table.options)
    for (const std::string& given : o.name == "input" && o.given.empty()   ? std::vector<std::string>{"-"}
                                    : o.argument || o.value_name == "FILE" ? o.given
                                                                           : std::vector<std::string>{}) {
      const std::string path = given == "-" ? "<stdin>" : given;
      if (message.rfind(path + ':', 0) != 0)
        continue;
      const Kind wanted = wanted_kind(table, o);
      const auto& [found, packed] =
          given == "-"
              ? OpenedFile{standard_input_was_empty() ? empty_file() : file_kind(head_of_standard_input()), false}
              : look_at_file(path);
      const bool input = o.name == "input" && !table.page.files.empty();
      const auto says = [&](const std::string& text, const char* word) { return text.find(word) != text.npos; };
      const bool unpacks =
          input && (says(table.page.files[0].name, ".gz") || says(table.page.files[0].meaning, ".gz"));
      const bool reads =
          found.kind == wanted || (wanted == Kind::map && found.kind == Kind::density) || wanted == Kind::unknown;
      if (packed && !(unpacks && found.kind != Kind::density) && (reads || found.what.empty()))
        return path + ":1: found " + (found.what.empty() ? "a file" : found.what) + " packed by gzip, expected " +
               name_of(wanted) + ": run gunzip first";
      if (!reads && !found.what.empty())
        return path + ":1: found " + found.what + ", expected " + name_of(wanted) + ": " +
               advice(found, wanted, table.program, o.name == "input" || o.name == "meshes");
    }
  return message;
}

int failed(const Table& table, const Common& options, const std::exception& e) {
  const auto* error = dynamic_cast<const Error*>(&e);
  const bool memory = dynamic_cast<const std::bad_alloc*>(&e) || dynamic_cast<const std::length_error*>(&e);
  std::string text = memory ? "not enough memory" : error ? with_flags(*error, table) : e.what();
  Status status = error ? error->status : Status::failed;
  if (error && blames_input(*error, table)) {
    text = (options.input == "-" ? "<stdin>" : options.input) + ": " + text;
    status = Status::bad_input;
  }
  if (status == Status::bad_input)
    text = with_kind(table, text);
  if (text == options.input + ": is a directory, expected a file" && !table.page.several.empty())
    text += "; " + table.page.several;
  std::cerr << table.program << ": " << one_line(text) << '\n';
  return static_cast<int>(status);
}

/// Asked for and not there: refused. By default: half of what can be started, which leaves memory to work in.
void settle_threads(Common& o, int threads) {
  const int startable = startable_threads(threads);
  if (startable == threads)
    return;
  if (o.threads > 0)
    fail(Status::failed, "-t: found " + std::to_string(threads) + ", expected at most " +
                             std::to_string(startable) +
                             ": no more threads can be started (limits of memory or processes)");
  o.threads = std::max(1, startable / 2);
  startable_threads(o.threads);
}

} // namespace

int run_program(Table& table, Common& options, int argc, char** argv, const std::function<void()>& describe,
                const std::function<Status(Run&)>& work) {
  try {
    guard_process();
    settle_heap();
    std::ios::sync_with_stdio(false);
    describe_common(table, options);
    describe();
    if (const int status = parse(table, argc, argv); status >= 0)
      return status;
    if (options.mode == "auto" && !options.chooses_mode)
      options.mode = "omp";
    const int threads = options.resolved_threads(); // a mode that is not here stops before any file is touched
    if (!options.on_device())                       // whose driver sets aside addresses beyond any memory
      limit_memory(threads);
    if (threads > 1 && options.uses_threads)
      settle_threads(options, threads);
    const std::unique_ptr<OutputFile> report = open_report(table, options);
    if (!options.quiet)
      terminal_note =
          table.program + ": reading from the terminal; " + table.program + " --help tells how it is used\n";
    Run run;
    run.tool = table.program;
    run.quiet = options.quiet;
    run.verbose = options.verbose;
    if (options.threads > threads && options.mode == "seq")
      run.note("-t " + std::to_string(options.threads) + ": --mode seq is one thread");
    const Status result = work(run);
    run.hide_phases();
    return finish(table, options, run, report.get(), result);
  } catch (const std::exception& e) {
    return failed(table, options, e);
  }
}

} // namespace molmesh::cli

// run.cpp — common options, exit statuses, the run report.
#include "cli/run.hpp"
#include "cli/cpus.hpp"
#include "cli/help.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <new>
#include <stdexcept>
#include <sys/resource.h>
#include <unistd.h>

#ifndef MOLMESH_VERSION
#define MOLMESH_VERSION "0.0.0"
#endif

namespace molmesh::cli {
namespace {

/// One printable line: control characters and bytes that are no UTF-8 become \xHH, and 2,000 characters are enough.
std::string one_line(const std::string& text) {
  std::string line;
  for (size_t i = 0; i < text.size() && line.size() < 2000;) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const size_t length = byte < 0x80                   ? 1
                          : byte >= 0xC2 && byte < 0xE0 ? 2
                          : byte >= 0xE0 && byte < 0xF0 ? 3
                          : byte >= 0xF0 && byte < 0xF5 ? 4
                                                        : 0;
    bool valid = length > 0 && i + length <= text.size() && byte >= 0x20 && byte != 0x7F;
    for (size_t k = 1; valid && k < length; ++k)
      valid = (static_cast<unsigned char>(text[i + k]) & 0xC0) == 0x80;
    if (valid) {
      line.append(text, i, length);
      i += length;
    } else {
      char hex[8];
      std::snprintf(hex, sizeof hex, "\\x%02x", byte);
      line += text[i] == '\n' && i + 1 == text.size() ? "" : text[i] == '\n' ? "; " : hex;
      ++i;
    }
  }
  return line;
}

} // namespace

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
}

void Run::end_phase() {
  if (open_ == none)
    return;
  phases[open_].seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  open_ = none;
}

void Run::note(const std::string& line) const {
  if (!quiet)
    std::cerr << tool << ": " << one_line(line) << '\n';
}

std::string creator(const std::string& tool) {
  return tool + " " MOLMESH_VERSION;
}

std::vector<double> numbers(const std::string& option, const std::string& text, size_t count) {
  const auto refuse = [&] {
    fail(Status::usage, option + ": found '" + text + "', expected " + std::to_string(count) +
                            (count == 1 ? " finite number" : " finite numbers separated by commas"));
  };
  std::vector<double> v;
  const char *p = text.data(), *end = p + text.size();
  while (v.size() < count) {
    double x = 0;
    const auto [next, error] = std::from_chars(p, end, x);
    if (error != std::errc{} || !std::isfinite(x))
      refuse();
    v.push_back(x);
    p = next;
    if (v.size() < count && (p == end || *p++ != ','))
      refuse();
  }
  if (p != end)
    refuse();
  return v;
}

namespace detail {
namespace {

/// A number when the text is one, else the text.
nlohmann::ordered_json value_json(const std::string& text) {
  const auto number = nlohmann::ordered_json::parse(text, nullptr, false);
  return number.is_number() ? number : nlohmann::ordered_json(text);
}

/// The options in force, given or by default; files and verbosity stand elsewhere or do not matter.
nlohmann::ordered_json options_json(const CLI::App& app) {
  nlohmann::ordered_json j = nlohmann::ordered_json::object();
  for (const CLI::Option* option : app.get_options()) {
    if (const std::string name = option->get_name();
        option->get_positional() && name != "input" && option->count() > 0)
      j[name] = option->results().back();
    if (option->get_lnames().empty() || !option->get_configurable())
      continue;
    const std::string name = option->get_lnames().front();
    if (option->get_expected_min() == 0)
      j[name] = option->count() > 0;
    else if (option->get_items_expected_max() > 1)
      j[name] = option->results();
    else
      j[name] = value_json(option->count() > 0 ? option->results().back() : option->get_default_str());
  }
  return j;
}

/// No output is a file that is read, from standard input too, and the report is neither.
void require_distinct_files(const CLI::App& app, const Common& o) {
  std::vector<std::string> inputs;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    if (name != "--output" && name != "--report" && name != "input" &&
        (option->get_positional() || option->get_type_name() == "FILE"))
      inputs.insert(inputs.end(), option->results().begin(), option->results().end());
  }
  if (o.keep_input)
    inputs.push_back(o.input);
  std::replace(inputs.begin(), inputs.end(), std::string("-"), std::string("/dev/stdin"));
  std::erase_if(inputs, [](const std::string& input) { // a keyword, or what cannot be opened
    std::error_code none;
    return !std::filesystem::exists(input, none);
  });
  for (const std::string& output : o.outputs())
    for (const std::string& input : inputs)
      if (same_file(output, input))
        fail(Status::usage, "-o: found " + output + ", which is an input, expected another file");
  if (o.report.empty())
    return;
  inputs.push_back(o.input == "-" ? "/dev/stdin" : o.input);
  for (const std::string& input : inputs)
    if (same_file(o.report, input))
      fail(Status::usage, "--report: found " + o.report + ", expected another file than the input");
  for (const std::string& output : o.outputs())
    if (o.report == output || same_file(o.report, output) ||
        (standard_stream(o.report) == STDOUT_FILENO && standard_stream(output) == STDOUT_FILENO))
      fail(Status::usage, "--report: found " + o.report + ", expected another file than the output");
}

} // namespace

void describe_common(CLI::App& app, Common& o) {
  app.option_defaults()->always_capture_default();
  app.set_help_flag("-h,--help", "show this help and stop")->configurable(false);
  app.set_version_flag("--version", creator(app.get_name()), "show the version and stop")->configurable(false);
  app.add_option("input", o.input, "input file; - is standard input")->configurable(false);
  app.add_option("-o,--output", o.output, "output file; - is standard output")
      ->type_name("FILE")
      ->configurable(false);
  app.add_option("--mode", o.mode, "seq: one thread, omp: many cores, cuda: one GPU")
      ->type_name("MODE")
      ->check(CLI::IsMember({"seq", "omp", "cuda"}));
  app.add_option("-t,--threads", o.threads, "threads for --mode omp; 0: all that are granted")
      ->check(CLI::Range(0, 1024));
  app.add_option("--report", o.report, "write the run report (JSON) to this file")
      ->type_name("FILE")
      ->configurable(false);
  app.add_flag("-q,--quiet", o.quiet, "errors only on standard error")->configurable(false);
  app.add_flag("-v,--verbose", o.verbose, "phases and their seconds on standard error")->configurable(false);
}

int parse(CLI::App& app, int argc, char** argv) {
  const auto print = [](const std::string& text) {
    std::cout << text << std::flush;
    if (!std::cout)
      fail(Status::not_written, "<stdout>: cannot write");
    return static_cast<int>(Status::good);
  };
  try {
    for (int i = 1; i < argc && std::string(argv[i]) != "--"; ++i) // CLI11 would take the next argument instead
      if (const std::string arg = argv[i]; arg.rfind("--", 0) == 0 && arg.find('=') + 1 == arg.size())
        throw CLI::ArgumentMismatch(arg.substr(0, arg.size() - 1) + ": found '', expected a value");
    app.parse(argc, argv);
    check_values(app);
    return -1;
  } catch (const CLI::CallForHelp&) {
    return print(help(app));
  } catch (const CLI::CallForVersion&) {
    return print(app.version() + '\n');
  } catch (const CLI::ParseError& e) {
    std::cerr << app.get_name() << ": " << one_line(plain_error(app, e)) << " (see " << app.get_name()
              << " --help)\n";
    return static_cast<int>(Status::usage);
  }
}

std::unique_ptr<OutputFile> open_report(const CLI::App& app, const Common& o) {
  require_distinct_files(app, o);
  return o.report.empty() ? nullptr : std::make_unique<OutputFile>(o.report);
}

int finish(const CLI::App& app, const Common& o, Run& run, OutputFile* report, Status status) {
  run.end_phase();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const int64_t peak_rss_bytes = int64_t{usage.ru_maxrss} * 1024;
  if (run.verbose) {
    for (const Run::Phase& p : run.phases)
      std::fprintf(stderr, "%s: %-16s %8.3f s\n", run.tool.c_str(), p.name.c_str(), p.seconds);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    std::fprintf(stderr, "%s: %.3f s of processor time, %.1f MB at most\n", run.tool.c_str(),
                 seconds(usage.ru_utime) + seconds(usage.ru_stime), 1e-6 * double(peak_rss_bytes));
  }
  if (report) {
    nlohmann::ordered_json j;
    j["tool"] = run.tool;
    j["version"] = MOLMESH_VERSION;
    j["mode"] = o.mode;
    j["threads"] = o.resolved_threads();
    j["input"] = o.input;
    j["output"] = o.output;
    j["options"] = options_json(app);
    j["phases"] = nlohmann::ordered_json::array();
    for (const Run::Phase& p : run.phases)
      j["phases"].push_back({{"name", p.name}, {"seconds", p.seconds}});
    j["counts"] = run.counts;
    j["peak_rss_bytes"] = peak_rss_bytes;
    report->stream() << j.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    run.complete(*report);
  }
  for (CompleteFile& file : run.outputs)
    file.publish();
  return static_cast<int>(status);
}

int failed(const std::string& tool, const std::exception& e) {
  const auto* error = dynamic_cast<const Error*>(&e);
  const bool memory = dynamic_cast<const std::bad_alloc*>(&e) || dynamic_cast<const std::length_error*>(&e);
  std::cerr << tool << ": " << (memory ? "not enough memory" : one_line(e.what())) << '\n';
  return static_cast<int>(error ? error->status : Status::failed);
}

} // namespace detail
} // namespace molmesh::cli

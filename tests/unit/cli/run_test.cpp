// run_test.cpp — options, exit statuses and the run report of a tool that doubles numbers.
#include "child.hpp"
#include "cli/run.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace molmesh;
using namespace molmesh::test;

namespace {

struct Options : cli::Common {
  double spacing = 0.25;
  int parts = 8;
  bool fill = false;
  std::string domains;
  std::vector<std::string> rules;
};

void describe(cli::Table& table, Options& o) {
  table.add("--spacing", o.spacing, "distance of grid points").unit("Å").within(0.01, 10);
  table.add("--parts", o.parts, "number of parts").positive();
  table.add("-r,--rule", o.rules, "resolution rule");
  table.add("--domains", o.domains, "domains of the structure").unit("FILE");
  table.add("--fill", o.fill, "fill cavities");
}

using Body = std::function<Status(const Options&, cli::Run&)>;

Status write_spacing(const Options& o, cli::Run& run) {
  run.phase("work");
  run.phase("rest");
  run.phase("work"); // goes on
  run.counts["points"] = 27;
  cli::OutputFile file(o.output);
  file.stream() << o.spacing << '\n';
  run.complete(file);
  return Status::good;
}

Outcome tool(
    std::vector<std::string> args, const Body& body = write_spacing, const std::function<void()>& before = [] {}) {
  args.insert(args.begin(), "doubler");
  return in_child(
      [&] {
        std::vector<char*> argv;
        for (std::string& a : args)
          argv.push_back(a.data());
        return cli::run_main<Options>("doubler", "doubles numbers", static_cast<int>(argv.size()), argv.data(),
                                      describe, body);
      },
      before);
}

size_t lines(const std::string& text) {
  return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

} // namespace

TEST_CASE("help and version answer on standard output with status 0") {
  for (const char* flag : {"-h", "--help"}) {
    const Outcome o = tool({flag});
    CHECK(o.status == 0);
    CHECK(o.err.empty());
    CHECK(o.out.rfind("doubler: doubles numbers\n", 0) == 0);
  }
  CHECK(tool({"--version"}).out.rfind("doubler ", 0) == 0);
  CHECK(tool({"--version"}).status == 0);
}

TEST_CASE("help shows unit, range and live default") {
  const std::string help = tool({"--help"}).out;
  INFO(help);
  CHECK(help.find("      --spacing Å         distance of grid points (0.01..10; default 0.25)\n") !=
        std::string::npos);
  CHECK(help.find("      --parts N           number of parts (> 0; default 8)\n") != std::string::npos);
  CHECK(help.find(
            "      --mode MODE         seq: one thread, omp: many cores, cuda: one GPU, auto: omp, or cuda if\n"
            "                          it makes the same bytes sooner (auto, seq, omp, cuda; default auto)\n") !=
        std::string::npos);
  CHECK(help.find("  -r, --rule TEXT         resolution rule (repeatable)\n") != std::string::npos);
  CHECK(help.find("      --domains FILE      domains of the structure\n") != std::string::npos);
  CHECK(help.find("      --fill              fill cavities\n") != std::string::npos);
}

TEST_CASE("wrong usage is status 2, one line, nothing on standard output") {
  const std::vector<std::vector<std::string>> wrong = {
      {"--colour"},         {"--spacing"},        {"--spacing", "0"},     {"--spacing", "nan"},
      {"--spacing", "inf"}, {"--spacing", "0x1"}, {"--spacing", "1,5"},   {"--spacing", "1Å"},
      {"--parts", "1.5"},   {"--parts", "-3"},    {"--mode", "gpu"},      {"-t", "-1"},
      {"--fill=maybe"},     {"a", "b"},           {"-o", "a", "-o", "b"}, {"-o", "-", "--report", "-"}};
  for (const auto& args : wrong) {
    const Outcome o = tool(args);
    INFO(args[0] << ' ' << (args.size() > 1 ? args[1] : "") << ": " << o.err);
    CHECK(o.status == 2);
    CHECK(o.out.empty());
    CHECK(lines(o.err) == 1);
    CHECK(o.err.rfind("doubler: ", 0) == 0);
  }
}

TEST_CASE("every exception becomes one printable line and its status") {
  const auto thrown = [](auto e) { return tool({}, [e](const Options&, cli::Run&) -> Status { throw e; }); };
  for (Status s :
       {Status::failed, Status::usage, Status::bad_input, Status::not_written, Status::mode_unavailable}) {
    const Outcome o = thrown(Error(s, "a.hier:7: found x, expected y"));
    CHECK(o.status == static_cast<int>(s));
    CHECK(o.err == "doubler: a.hier:7: found x, expected y\n");
  }
  CHECK(thrown(std::bad_alloc()).err == "doubler: not enough memory\n");
  CHECK(thrown(std::bad_alloc()).status == 1);
  CHECK(thrown(std::runtime_error("two\nlines\n")).err == "doubler: two; lines\n");
  CHECK(thrown(std::runtime_error("found '\xff\x01\x7f', expected 'Å'")).err ==
        "doubler: found '\\xff\\x01\\x7f', expected 'Å'\n");
  CHECK(tool({}, [](const Options&, cli::Run&) { return Status::below_quality; }).status == 5);
}

TEST_CASE("the flags of the quantities that an error names stand in its line") {
  const auto thrown = [](const Error& e, std::vector<std::string> args) {
    return tool(std::move(args), [e](const Options&, cli::Run&) -> Status { throw e; });
  };
  const Error first(Status::usage, "spacing: found 9, expected 8", {"spacing"});
  CHECK(thrown(first, {"--spacing", "9"}).err == "doubler: --spacing: found 9, expected 8\n");
  CHECK(thrown(first, {"--spacing", "9"}).status == 2);
  const Error two(Status::usage, "the grid is too large", {"spacing", "parts", "weight"});
  CHECK(thrown(two, {"--parts", "2"}).err == "doubler: the grid is too large (--spacing, --parts)\n");
  CHECK(thrown(two, {"--parts", "2"}).status == 2);
  // Nobody gave one of them: the input does not go with their defaults.
  CHECK(thrown(two, {"x.hier"}).err == "doubler: x.hier: the grid is too large (--spacing, --parts)\n");
  CHECK(thrown(two, {"x.hier"}).status == 3);
  CHECK(thrown(Error(Status::failed, "no room", {"parts"}), {}).err == "doubler: no room (--parts)\n");
  CHECK(thrown(Error(Status::failed, "no room", {"parts"}), {}).status == 1);
}

TEST_CASE("pages hold every option") {
  for (const char* kind : {"man", "markdown", "bash"}) {
    const Outcome o = tool({std::string("--help=") + kind});
    INFO(o.out);
    CHECK(o.status == 0);
    CHECK(o.err.empty());
    for (const char* name : {"spacing", "parts", "rule", "fill", "mode", "threads", "report", "help"})
      CHECK(o.out.find(name) != std::string::npos);
    const bool ascii = std::all_of(o.out.begin(), o.out.end(), [](char c) { return c > 0; });
    CHECK((ascii || kind == std::string("markdown")));
  }
}

TEST_CASE("mode cuda in a build without CUDA is status 6 before any work") {
  const Outcome o =
      tool({"--mode", "cuda"}, [](const Options&, cli::Run&) -> Status { throw std::logic_error("ran"); });
  CHECK(o.status == 6);
  CHECK(lines(o.err) == 1);
  CHECK(o.out.empty());
}

TEST_CASE("standard output that is closed, full or a broken pipe is status 4") {
  const auto point_at = [](const char* file) { return [file] { dup2(open(file, O_WRONLY), STDOUT_FILENO); }; };
  const auto broken_pipe = [] {
    int ends[2];
    if (pipe(ends) != 0)
      _exit(99);
    dup2(ends[1], STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
  };
  for (const std::vector<std::string>& args : {std::vector<std::string>{}, {"--help"}, {"--version"}}) {
    CHECK(tool(args, write_spacing, point_at("/dev/full")).status == 4);
    CHECK(tool(args, write_spacing, [] { close(STDOUT_FILENO); }).status == 4);
    const Outcome o = tool(args, write_spacing, broken_pipe);
    CHECK(o.status == 4);
    CHECK(lines(o.err) == 1);
  }
}

TEST_CASE("the run report holds the keys of the contract and the options in force") {
  const Folder folder;
  const int threads = par::has_threads() ? 3 : 1; // more are refused without OpenMP
  const Outcome o = tool({"in.hier", "-o", folder / "out", "--report", folder / "report", "--spacing", "0.5", "-r",
                          "*", "-r", "//A", "--fill", "-t", std::to_string(threads)});
  REQUIRE(o.status == 0);
  CHECK(o.out.empty());
  const auto j = nlohmann::json::parse(contents(folder / "report"));
  CHECK(j.size() == 10);
  CHECK(j.at("tool") == "doubler");
  CHECK(j.at("version").is_string());
  CHECK(j.at("mode") == "omp");
  CHECK(j.at("threads") == threads);
  CHECK(j.at("input") == "in.hier");
  CHECK(j.at("output") == folder / "out");
  auto options = nlohmann::json::parse(R"({"mode": "auto", "spacing": 0.5, "parts": 8, "rule": ["*", "//A"],
                                           "domains": "", "fill": true})");
  options["threads"] = threads;
  CHECK(j.at("options") == options);
  REQUIRE(j.at("phases").size() == 2);
  CHECK(j["phases"][0].at("name") == "work");
  CHECK(j["phases"][0].at("seconds").get<double>() >= 0);
  CHECK(j["phases"][1].at("name") == "rest");
  CHECK(j.at("counts").at("points") == 27);
  CHECK(j.at("peak_rss_bytes").get<int64_t>() > 1'000'000);
}

TEST_CASE("a report that cannot be written stops the run before its work, and a failed run leaves no report") {
  const Folder folder;
  CHECK(tool({"-o", folder / "out", "--report", folder / "absent/report"}).status == 4);
  CHECK(tool({"--report", folder / "report"}, [](const Options&, cli::Run&) -> Status {
          fail_input("x");
        }).status == 3);
  CHECK(folder.files() == 0);
}

TEST_CASE("more threads than the mode has are said") {
  CHECK(tool({"--mode", "seq", "-t", "4"}).err == "doubler: -t 4: --mode seq is one thread\n");
  CHECK(tool({"--mode", "seq", "-t", "1"}).err.empty());
}

TEST_CASE("an output gets its name when the report, too, could be written") {
  const Folder folder;
  CHECK(tool({"-o", folder / "out", "--report", "/dev/full"}).status == 4);
  CHECK(folder.files() == 0);
  CHECK(tool({"-o", folder / "out", "--report", folder / "report"}).status == 0);
  CHECK(folder.files() == 2);
}

TEST_CASE("notes go to standard error and -q silences them") {
  const Body body = [](const Options&, cli::Run& run) {
    run.note("12 waters dropped");
    return Status::good;
  };
  CHECK(tool({}, body).err == "doubler: 12 waters dropped\n");
  CHECK(tool({"-q"}, body).err.empty());
  CHECK(tool({"-v"}).err.find("work") != std::string::npos);
}

TEST_CASE("numbers() reads a fixed count, strictly") {
  CHECK(cli::numbers("--band", "0.9,1.1", 2) == std::vector<double>{0.9, 1.1});
  CHECK(cli::numbers("--box", "-1,2e1,3,4,5,.5", 6) == std::vector<double>{-1, 20, 3, 4, 5, 0.5});
  for (const char* text :
       {"", "1", "1,", ",1", "1,2,3", "1, 2", "1 2", "1,nan", "1,inf", "1,1e999", "1,0x2", "1,2 ", "1;2"}) {
    INFO(text);
    CHECK_THROWS_AS(cli::numbers("--band", text, 2), Error);
  }
}

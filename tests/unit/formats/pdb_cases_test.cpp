// pdb_cases_test.cpp — what programs write, kind by kind: read right or refused aloud (tests/data/cases.tsv).
#include "pdb_text.hpp"
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>

using namespace molmesh;
using namespace molmesh::test;
namespace fs = std::filesystem;

namespace {

struct Case {
  std::string file, select, status, atoms, residues, chains, holds, says, reason;
};

std::vector<Case> read_cases() {
  std::vector<Case> cases;
  std::ifstream table(MOLMESH_SOURCE_DIR "/tests/data/cases.tsv");
  for (std::string line; std::getline(table, line);) {
    if (line.empty() || line[0] == '#')
      continue;
    std::istringstream fields(line);
    Case c;
    for (std::string* field :
         {&c.file, &c.select, &c.status, &c.atoms, &c.residues, &c.chains, &c.holds, &c.says, &c.reason})
      std::getline(fields, *field, '\t');
    cases.push_back(c);
  }
  return cases;
}

/// Parts between " | ".
std::vector<std::string> parts(const std::string& text) {
  std::vector<std::string> all;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find(" | ", begin), text.size());
    all.push_back(text.substr(begin, end - begin));
    begin = end + 3;
  }
  return all;
}

} // namespace

TEST_CASE("every kind of file that programs write has the outcome that tests/data/cases.tsv decides") {
  const std::string folder = MOLMESH_SOURCE_DIR "/tests/data/cases/";
  std::set<std::string> decided;
  for (const Case& c : read_cases()) {
    INFO(c.file << ": " << c.reason);
    REQUIRE(!c.reason.empty());
    decided.insert(c.file);
    formats::PdbOptions options;
    options.waters = true;
    options.altloc = "all";
    options.surface = formats::PdbOptions::Surface::plain;
    if (c.select != "*")
      options.select = c.select;
    std::string said;
    try {
      const Converted got = convert(slurp(folder + c.file), options, c.file);
      for (size_t n = 1; n < got.report.notes.size(); ++n)
        said += (n > 1 ? "; " : "") + got.report.notes[n];
      CHECK(c.status == "0");
      CHECK(c.atoms == std::to_string(got.report.atoms));
      CHECK(c.residues == std::to_string(got.report.residues));
      CHECK(c.chains == std::to_string(got.report.chains));
      for (const std::string& line : parts(c.holds)) {
        INFO(line << " in\n" << got.text);
        CHECK(got.text.find("\n" + line + "\n") != std::string::npos);
      }
    } catch (const Error& e) {
      said = e.what();
      CHECK(c.status == std::to_string(static_cast<int>(e.status)));
    }
    CHECK(said == c.says);
  }
  for (const auto& entry : fs::directory_iterator(folder))
    if (const std::string name = entry.path().filename().string(); entry.path().extension() != ".py") {
      INFO(name);
      CHECK(decided.count(name) == 1);
    }
}

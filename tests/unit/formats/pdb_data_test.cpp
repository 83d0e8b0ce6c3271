// pdb_data_test.cpp — reads real files, usual and odd, of the folder of test data.
#include "pdb_text.hpp"
#include "unit/test_data.hpp"
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>

using namespace molmesh;
using namespace molmesh::test;
namespace fs = std::filesystem;

namespace {

struct Outcome {
  std::string status, atoms = "-", residues = "-", chains = "-", message;
};

Outcome outcome(const fs::path& path) {
  const std::string name = path.filename().string();
  formats::PdbOptions options;
  options.surface = formats::PdbOptions::Surface::plain;
  try {
    const Converted c = convert(slurp(path.string()), options, name);
    std::string notes;
    for (size_t n = 1; n < c.report.notes.size(); ++n)
      notes += (n > 1 ? "; " : "") + c.report.notes[n];
    return {"0", std::to_string(c.report.atoms), std::to_string(c.report.residues), std::to_string(c.report.chains),
            notes};
  } catch (const Error& e) {
    std::string what = e.what();
    CHECK(what.find('\n') == std::string::npos);
    REQUIRE(what.rfind(name + ":", 0) == 0);
    what.erase(0, name.size() + 1);
    return {std::to_string(static_cast<int>(e.status)), "-", "-", "-", what.substr(what.find_first_not_of(' '))};
  }
}

/// What of a .hier does not name its source.
std::string body(const std::string& hier) {
  return hier.substr(hier.find("\nlevels"));
}

} // namespace

TEST_CASE("every odd file has the outcome that tests/data/odd.tsv decides") {
  const fs::path folder = data("odd");
  if (folder.empty())
    return;
  std::map<std::string, Outcome> decided;
  std::ifstream table(MOLMESH_SOURCE_DIR "/tests/data/odd.tsv");
  for (std::string line; std::getline(table, line);) {
    if (line.empty() || line[0] == '#')
      continue;
    std::istringstream fields(line);
    std::string file;
    Outcome o;
    for (std::string* field : {&file, &o.status, &o.atoms, &o.residues, &o.chains, &o.message})
      std::getline(fields, *field, '\t');
    decided[file] = o;
  }
  REQUIRE(decided.size() > 170);
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    INFO(name);
    REQUIRE(decided.count(name) == 1);
    const Outcome got = outcome(entry.path()), &expected = decided[name];
    CHECK(got.status == expected.status);
    CHECK(got.atoms == expected.atoms);
    CHECK(got.residues == expected.residues);
    CHECK(got.chains == expected.chains);
    CHECK(got.message == expected.message);
  }
}

TEST_CASE("the ways to write 1CRN down all give 1CRN") {
  const fs::path odd = data("odd"), typical = data("typical");
  if (odd.empty() || typical.empty())
    return;
  const std::string expected = body(convert(slurp((typical / "1crn.pdb").string())).text);
  for (const char* name : {"cr_only.pdb", "crlf.pdb", "no_element.pdb", "no_newline_eof.pdb", "nonascii_latin1.pdb",
                           "nonascii_utf8.pdb", "plain_named_gz.pdb.gz", "shifted_one_col.pdb",
                           "short_lines_54.pdb", "two_members.pdb.gz", "utf8_bom.pdb"}) {
    INFO(name);
    CHECK(body(convert(slurp((odd / ("synth_" + std::string(name))).string()), {}, name).text) == expected);
  }
}

TEST_CASE("PDB and mmCIF of an entry give the same hierarchy") {
  const fs::path typical = data("typical");
  if (typical.empty())
    return;
  int pairs = 0;
  for (const auto& entry : fs::directory_iterator(typical)) {
    std::string name = entry.path().filename().string();
    const size_t cif = name.find(".cif");
    if (cif == std::string::npos)
      continue;
    const std::string pdb = name.substr(0, cif) + ".pdb" + name.substr(cif + 4);
    if (!fs::exists(typical / pdb))
      continue;
    INFO(name);
    CHECK(body(convert(slurp(entry.path().string()), {}, name).text) ==
          body(convert(slurp((typical / pdb).string()), {}, pdb).text));
    ++pairs;
  }
  CHECK(pairs >= 4);
}

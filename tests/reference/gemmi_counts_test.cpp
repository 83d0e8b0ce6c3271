// gemmi_counts_test.cpp — atoms, residues and chains of real files, counted by gemmi on its own.
// gemmi undefines CHECK: before Catch.
#include <gemmi/gz.hpp>
#include <gemmi/mmread.hpp>

#include "base/error.hpp"
#include "formats/pdb/pdb.hpp"
#include "unit/test_data.hpp"
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

using namespace molmesh;
namespace fs = std::filesystem;

namespace {

/// Where gemmi 0.5.7 reads what the file does not mean, and why.
const std::map<std::string, std::string> gemmi_reads_otherwise = {
    {"bigbox_132303atoms_wrapped_serials.pdb.gz", "44101 waters whose numbers wrap at 9999"},
    {"popc_bilayer.pdb.gz", "POPC is no POP of chain C; waters have the lipids' numbers"},
    {"yiip_in_membrane.pdb.gz", "POPE and POPG are no POP; both monomers have the same numbers"},
    {"ngl_pbc_5digit_resid_shifted.pdb.gz", "DMPC is no DMP of chain C"},
    {"mda_align.pdb", "a segment without a chain"},
    {"mdtraj_vmd_indexing.pdb", "after 9999 comes 2710, hexadecimal"},
    {"mdtraj_overflow_indexing.pdb", "two waters whose numbers are both ****"},
    {"mda_sameresid_diffresname.pdb", "POPC of chain S is no POP of chain CS"},
};

struct Runs {
  int64_t residues = 0, chains = 0;
};

/// Residues as lines that follow each other, chains by column 22 or the segment: the first model alone.
Runs count_runs(const std::string& path) {
  const gemmi::CharArray unpacked =
      gemmi::MaybeGzipped(path).uncompress_into_buffer(); // empty where it is not packed
  std::ostringstream plain;
  plain << std::ifstream(path, std::ios::binary).rdbuf();
  std::istringstream in(unpacked.size() > 0 ? std::string(unpacked.data(), unpacked.size()) : plain.str());
  Runs counted;
  std::set<std::string> chains;
  std::string before, first;
  for (std::string line; std::getline(in, line) && line.rfind("END", 0) != 0;) {
    if (line.rfind("ATOM", 0) != 0 && line.rfind("HETATM", 0) != 0)
      continue;
    line.resize(80, ' ');
    const std::string residue = line.substr(17, 10);
    const std::string name = line.substr(12, 4);
    if (residue != before || (residue.find('*') != std::string::npos && name == first)) {
      ++counted.residues;
      first = name;
    }
    before = residue;
    chains.insert(line[21] == ' ' ? line.substr(72, 4) : line.substr(21, 1));
  }
  counted.chains = static_cast<int64_t>(chains.size());
  return counted;
}

} // namespace

TEST_CASE("atoms, residues and chains are those that gemmi counts") {
  const fs::path data = test::data("");
  if (data.empty())
    return;
  formats::PdbOptions all;
  all.waters = true;
  all.altloc = "all";
  int files = 0, by_run = 0;
  for (const char* folder : {"typical", "paper", "large", "odd"})
    for (const auto& entry : fs::directory_iterator(data / folder)) {
      const std::string path = entry.path().string();
      INFO(path);
      if (path.find(".pqr") != std::string::npos)
        continue;
      std::ifstream in(path, std::ios::binary);
      int64_t atoms = 0, residues = 0, chains = 0;
      try {
        const formats::PdbHierarchy ours(in, path, all);
        atoms = ours.report().atoms;
        residues = ours.report().residues;
        chains = ours.report().chains;
      } catch (const Error&) {
        continue; // decided in tests/data/odd.tsv
      }
      gemmi::Structure theirs;
      try {
        theirs = gemmi::read_structure(gemmi::MaybeGzipped(path));
      } catch (const std::exception&) {
        continue; // what gemmi refuses and we read
      }
      if (theirs.models.empty() || theirs.models[0].chains.empty())
        continue;
      theirs.merge_chain_parts();
      const gemmi::Model& model = theirs.models[0];
      int64_t their_residues = 0, their_atoms = 0;
      for (const gemmi::Chain& chain : model.chains) {
        their_residues += static_cast<int64_t>(chain.residues.size());
        for (const gemmi::Residue& residue : chain.residues)
          their_atoms += static_cast<int64_t>(residue.atoms.size());
      }
      CHECK(atoms == their_atoms);
      if (const auto known = gemmi_reads_otherwise.find(entry.path().filename().string());
          known != gemmi_reads_otherwise.end()) {
        INFO(known->second);
        const Runs by_hand = count_runs(path);
        CHECK(residues == by_hand.residues);
        CHECK(chains == by_hand.chains);
        CHECK((residues != their_residues || chains != static_cast<int64_t>(model.chains.size())));
        ++by_run;
        continue;
      }
      CHECK(residues == their_residues);
      CHECK(chains == static_cast<int64_t>(model.chains.size()));
      ++files;
    }
  CHECK(files > 150);
  CHECK(by_run == static_cast<int>(gemmi_reads_otherwise.size()));
}

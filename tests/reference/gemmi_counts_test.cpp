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

using namespace molmesh;
namespace fs = std::filesystem;

TEST_CASE("atoms, residues and chains are those that gemmi counts") {
  const fs::path data = test::data("");
  if (data.empty())
    return;
  formats::PdbOptions all;
  all.waters = true;
  all.altloc = "all";
  int files = 0;
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
      CHECK(residues == their_residues);
      CHECK(chains == static_cast<int64_t>(model.chains.size()));
      ++files;
    }
  CHECK(files > 150);
}

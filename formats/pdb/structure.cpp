// structure.cpp — what gemmi does with its structure, done with ours.
#include "formats/pdb/structure.hpp"
#include <functional>
#include <gemmi/polyheur.hpp>
#include <utility>

namespace molmesh::formats::pdb {

bool Residue::is_water() const {
  const std::string& n = name;
  if (n.size() != 3)
    return false;
  const int id = gemmi::ialpha4_id(n.c_str());
  return id == gemmi::ialpha4_id("HOH") || id == gemmi::ialpha4_id("DOD") || id == gemmi::ialpha4_id("WAT") ||
         id == gemmi::ialpha4_id("H2O");
}

size_t hash(const ResidueId& id) {
  const auto mix = [](size_t h, size_t more) { return (h ^ more) * size_t{0x9E3779B97F4A7C15} ^ (h >> 29); };
  const std::hash<std::string> of_text;
  // gemmi compares insertion codes in any case.
  const auto number = static_cast<size_t>(static_cast<unsigned>(id.seqid.num.has_value() ? *id.seqid.num : -999));
  return mix(mix(mix(static_cast<size_t>(id.seqid.icode | 0x20), number), of_text(id.segment)), of_text(id.name));
}

void name_subchains(Chain& chain, Labels& labels) {
  for (Residue& residue : chain.residues)
    switch (residue.entity_type) {
    case gemmi::EntityType::Polymer:
      residue.subchain = labels.add(chain.name.str() + "poly");
      break;
    case gemmi::EntityType::NonPolymer:
      residue.subchain = labels.add(chain.name.str() + residue.seqid.str());
      break;
    case gemmi::EntityType::Water:
      residue.subchain = labels.add(chain.name.str() + "wat");
      break;
    default:
      residue.subchain = chain.name;
    }
}

void set_up_entities(Structure& structure) {
  gemmi::Structure theirs;
  theirs.entities = std::move(structure.entities);
  for (const Model& model : structure.models) {
    gemmi::Model& m = theirs.models.emplace_back(model.name);
    for (const Chain& chain : model.chains) {
      gemmi::Chain& c = m.chains.emplace_back(chain.name);
      for (const Residue& residue : chain.residues) {
        gemmi::Residue& r = c.residues.emplace_back();
        r.seqid = residue.seqid;
        r.name = residue.name;
        r.subchain = residue.subchain;
        r.entity_type = residue.entity_type;
        r.het_flag = residue.het_flag;
        // Whether there is an alpha carbon or a phosphorus tells of an unknown residue what it is.
        for (const Atom& atom : residue.atoms)
          if (atom.name == "CA" || atom.name == "P") {
            gemmi::Atom& a = r.atoms.emplace_back();
            a.name = atom.name;
            a.element = atom.element;
          }
      }
    }
  }
  gemmi::setup_entities(theirs);
  for (size_t m = 0; m < structure.models.size(); ++m)
    for (size_t c = 0; c < structure.models[m].chains.size(); ++c)
      for (size_t r = 0; r < structure.models[m].chains[c].residues.size(); ++r) {
        const gemmi::Residue& from = theirs.models[m].chains[c].residues[r];
        Residue& to = structure.models[m].chains[c].residues[r];
        to.entity_type = from.entity_type;
        to.subchain = structure.labels.add(from.subchain);
      }
  structure.entities = std::move(theirs.entities);
}

} // namespace molmesh::formats::pdb

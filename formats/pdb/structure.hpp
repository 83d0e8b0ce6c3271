// structure.hpp — models, chains, residues and atoms of a structure file, in a third of the memory of gemmi's.
#pragma once
#include "molecule/hierarchy.hpp"
#include <cstddef>
#include <cstdint>
#include <gemmi/model.hpp>
#include <string>
#include <string_view>
#include <vector>

/// Fields are named as gemmi's, and mean the same.
namespace molmesh::formats::pdb {

/// A text that Labels hold, or somebody else who outlives this: a file has many atoms and few names.
class Label {
public:
  Label() : text_(&none()) {}
  explicit Label(const std::string& text) : text_(&text) {}
  explicit Label(std::string&&) = delete;
  const std::string& str() const { return *text_; }
  operator const std::string&() const { return *text_; }
  bool empty() const { return text_->empty(); }
  friend bool operator==(Label a, Label b) { return a.text_ == b.text_ || *a.text_ == *b.text_; }
  friend bool operator!=(Label a, Label b) { return !(a == b); }
  friend bool operator==(Label a, std::string_view b) { return *a.text_ == b; }
  friend bool operator!=(Label a, std::string_view b) { return *a.text_ != b; }

private:
  static const std::string& none() {
    static const std::string text;
    return text;
  }
  const std::string* text_;
};

/// The texts of a file, each once.
class Labels {
public:
  Labels() = default;
  Labels(const Labels&) = delete; // what labels refer to stays where it is when these are moved
  Labels& operator=(const Labels&) = delete;
  Labels(Labels&&) = default;
  Labels& operator=(Labels&&) = default;
  Label add(std::string_view text) { return text.empty() ? Label() : Label(all_[all_.add(text)]); }
  size_t size() const { return static_cast<size_t>(all_.size()); }

private:
  Names all_;
};

struct Atom {
  Label name;
  gemmi::Position pos; ///< Å
  float occ = 1, b_iso = 20;
  int32_t serial = 0; ///< place in the file, from 0
  gemmi::Element element = gemmi::El::X;
  char altloc = '\0';
  bool is_hydrogen() const { return gemmi::is_hydrogen(element); }
};

struct ResidueId {
  gemmi::SeqId seqid;
  Label segment, name;
  bool matches(const ResidueId& o) const { return seqid == o.seqid && segment == o.segment && name == o.name; }
};

struct Residue : ResidueId {
  Label subchain, entity_id;
  gemmi::EntityType entity_type = gemmi::EntityType::Unknown;
  char het_flag = '\0';    ///< 'A': ATOM, 'H': HETATM
  char flag = '\0';        ///< modified_residue
  bool begins_run = false; ///< in the file another chain stands before it
  std::vector<Atom> atoms;

  Residue() = default;
  explicit Residue(const ResidueId& id) : ResidueId(id) {}
  /// By the names of the PDB.
  bool is_water() const;
};

struct Chain {
  Label name;
  std::vector<Residue> residues;
  explicit Chain(Label its_name) : name(its_name) {}
};

struct Model {
  std::string name;
  std::vector<Chain> chains;
  explicit Model(std::string its_name) : name(std::move(its_name)) {}
};

struct Structure {
  Labels labels; ///< of all that is in `models`
  std::vector<Model> models;
  std::vector<gemmi::Entity> entities;
  std::vector<gemmi::Assembly> assemblies;
};

/// A hash of what matches() compares.
size_t hash(const ResidueId& id);

/// As gemmi::assign_subchain_names(): by the chain's name and the kind of residue.
void name_subchains(Chain& chain, Labels& labels);

/// As gemmi::setup_entities(), which it asks: subchains and kinds of residues, and the entities that they belong
/// to.
void set_up_entities(Structure& structure);

} // namespace molmesh::formats::pdb

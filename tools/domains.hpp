// domains.hpp — regions that are groups of one level of a hierarchy: their shares, numbers and names.
#pragma once
#include "base/error.hpp"
#include "cli/file.hpp"
#include "contour/octree/owner_borders.hpp"
#include "formats/hier/hier.hpp"
#include "formats/vtu/names.hpp"
#include "label/divide.hpp"
#include "label/equal_shares.hpp"
#include "mesh/same_source.hpp"
#include "molecule/bodies.hpp"
#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace molmesh {

class Domains {
public:
  /// file: the hierarchy's, for messages. Throws Error(bad_input) where h has no level of that name, or one group
  /// of it alone, or a group has a name that meshes have themselves.
  Domains(const Hierarchy& h, const std::string& file, const std::string& level, label::Options options)
      : file_(file), level_(level), level_index_(index_of(h, file, level)), shares_(h, level_index_, options),
        threads_(options.threads) {
    if (h.level[level_index_].group.size() < 2)
      fail_input(file + ": one " + level + ", expected two or more: nothing is to be divided");
    std::set<std::string> taken;
    for (const Group& g : h.level[level_index_].group) {
      if (formats::is_own_name(g.name))
        fail_input(file + ": found the " + level + " '" + g.name +
                   "', which is the meshes' own name, expected another");
      std::string name = g.name;
      for (int k = 2; !taken.insert(name).second; ++k)
        name = g.name + '_' + std::to_string(k);
      name_.push_back(name);
    }
  }

  /// Keeps a reference to this.
  contour::FindOwners owners() const {
    return [this](const std::vector<Vec3d>& place) {
      std::vector<contour::Owner> all;
      for (const label::Shares& s : shares_.at(place))
        all.push_back({s.owner(), s.lead()});
      return all;
    };
  }

  /// Divides region 1 and names what comes of it. The regions' names. Throws Error(bad_input) for more interfaces
  /// than the optimizer has labels.
  std::vector<std::string> divide(TetMesh& m) const {
    constexpr size_t most_interfaces = 240;
    const label::Division d = label::divide(m, shares_, threads_);
    if (d.between.size() > most_interfaces)
      fail_input(file_ + ": " + std::to_string(d.group.size()) + " groups of level " + level_ + " meet in " +
                 std::to_string(d.between.size()) + " interfaces, expected at most " +
                 std::to_string(most_interfaces));
    std::map<int32_t, std::string> region, boundary;
    std::vector<std::string> names;
    for (const int32_t g : d.group) {
      region[label::first_domain + g] = name_[g];
      names.push_back(name_[g]);
    }
    for (const auto& [l, pair] : d.between)
      boundary[l] = name_[pair[0]] + '-' + name_[pair[1]];
    formats::add_region_names(m, level_, region, boundary);
    return names;
  }

  /// Of each interface of the mesh, where the shares are equal. file: the hierarchy's.
  std::map<int32_t, std::shared_ptr<const Target>> interfaces(const TetMesh& m, const GridFrame& frame,
                                                              const std::string& file) const {
    std::map<int32_t, std::shared_ptr<const Target>> all;
    for (const auto& [l, i] : label::interfaces_of(m)) {
      if (i.group[0] < 0 || i.group[1] >= static_cast<int32_t>(name_.size()) || i.group[0] >= i.group[1])
        fail_input(file + ": " + std::to_string(name_.size()) + " groups of level " + level_ +
                   ", expected those of the mesh's boundary " + std::to_string(l));
      all[l] = std::make_shared<label::EqualShares>(shares_, i, frame, threads_);
    }
    return all;
  }

private:
  static size_t index_of(const Hierarchy& h, const std::string& file, const std::string& level) {
    std::string known;
    for (size_t l = 0; l < h.level.size(); ++l) {
      if (h.level[l].name == level)
        return l;
      known += (known.empty() ? "" : ", ") + h.level[l].name;
    }
    fail_input(file + ": no level '" + level + "', expected one of " +
               (known.empty() ? "its levels: it has none" : known));
  }
  std::string file_, level_;
  size_t level_index_;
  label::ShareFinder shares_;
  int threads_;
  std::vector<std::string> name_;
};

/// Of density2tet's options. sized: there is a --size.
inline void check_regions(const std::string& regions, const std::string& hier, const std::string& region,
                          bool sized) {
  if (sized && hier.empty())
    fail(Status::usage, "--size: found no --hier, expected the hierarchy that the selection is of");
  if (!sized && regions == "molecule" && !hier.empty())
    fail(Status::usage, "--hier: found without --regions and --size, expected one of them");
  if (!sized && (regions != "molecule") != !hier.empty())
    fail(Status::usage, "--regions: found " + regions + (hier.empty() ? " without --hier" : " with --hier") +
                            ", expected a level and --hier, or neither");
  if (regions != "molecule" && region == "exterior")
    fail(Status::usage, "--regions: found --region exterior, expected interior or both");
}

/// The hierarchy in a file, which is of the grid's structure.
inline Hierarchy read_structure(const std::string& file, const FieldInfo& field) {
  cli::InputFile input(file);
  Hierarchy h = formats::read_hier(input.stream(), input.name());
  if (other_structure(h.source, field.source) || !may_be_of(h, field.atoms))
    fail_input(file + ": " + std::to_string(atoms_with_body(h)) + " atoms of " + h.source + ", expected the " +
               std::to_string(field.atoms) + " atoms of the density's " + field.source);
  return h;
}

} // namespace molmesh

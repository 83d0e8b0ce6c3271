// parity.hpp — the device's stages compared with the host's, a line for each.
#pragma once
#include "stages.hpp"
#include <string>

namespace molmesh::gpu {

class Parity {
public:
  Parity(const How& device, const How& reference) : device_(device), reference_(reference) {}
  /// Every so many of the cases.
  void small(int step);
  /// One case, for tools that take a thousand times as long.
  void tiny();
  /// The stages up to `last`, each from the host's result of the one before.
  void structure(const std::string& name, const Hierarchy& h, const density::Options& o, Stage last);
  /// Of the density, with a third of the memory; not must_fit: unless not one block's slab fits.
  void slabs(const std::string& name, const Hierarchy& h, const density::Options& o, bool must_fit);
  int failures() const { return failures_; }

private:
  void tell(const std::string& what, const std::string& fault);
  /// Ambiguous cells, ties, both regions, cut boxes: connectivity and positions to the last bit.
  void random_grids(int step);
  /// What octrees and boxes there are besides the plain ones.
  void forms();
  How device_, reference_;
  int failures_ = 0;
};

} // namespace molmesh::gpu

// leaves.hpp — blocks of the density as the bytes of an OpenVDB file's leaves, compressed as they come.
#pragma once
#include "grid/band.hpp"
#include "par/arena.hpp"
#include "par/pool.hpp"
#include <span>
#include <vector>

namespace molmesh::formats {

/// What write_vdb() puts behind the tree: an OpenVDB file has its topology first, so the leaves wait here. They
/// take as much memory as in the file.
class Leaves {
public:
  explicit Leaves(int threads) : threads_(threads) {}
  /// Nothing of the blocks is kept but the bytes.
  void add(std::span<const BandBlocks> runs, float inside_value);
  void add(const BlockGrid& grid);

  struct Leaf {
    Vec3i corner;
    uint32_t size;     ///< bytes
    const char* bytes; ///< first the mask of active points
    static constexpr size_t mask_size = 64;
  };
  using Run = std::vector<Leaf>;
  const std::vector<Run>& runs() const { return runs_; } ///< one for each add()
  size_t size() const;
  int threads() const { return threads_; }

private:
  /// A leaf's points: active ones, inactive ones inside, and the values of the active ones in order.
  struct View {
    Vec3i corner;
    const uint64_t *active, *inside;
    const float* packed;
  };
  /// work(part, arena) for every part; each has the arena for itself.
  template <class Work>
  void for_parts(size_t parts, Work&& work);
  static Leaf encode(const View& view, float inside_value, par::Arena<char>& to);

  int threads_;
  std::vector<Run> runs_;
  par::Pool<par::Arena<char>> bytes_;
};

} // namespace molmesh::formats

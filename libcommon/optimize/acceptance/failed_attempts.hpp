// failed_attempts.hpp — remembers operations that failed: while their vertices are the same, they fail again.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace molmesh::optimize {

/// Forgets: a new one takes the place of an old one here and there.
class FailedAttempts {
public:
  enum class Operation : uint8_t { smooth, merge, split };
  struct Attempt {
    Operation operation = Operation::smooth;
    uint8_t aims = 0;            ///< of the acceptance, a bit each
    int32_t a = -1, b = -1;      ///< vertices; b = -1: a alone. a = -1: none
    int32_t element = -1;        ///< where it matters from which one
    uint32_t at_a = 0, at_b = 0; ///< DynamicMesh::state of the vertices
    float goal = 0;              ///< of the acceptance
    bool operator==(const Attempt&) const = default;
  };

  bool knows(const Attempt& attempt) const { return kept_[place(attempt)] == attempt; }
  void add(const Attempt& attempt) {
    if (2 * added_++ >= kept_.size() && kept_.size() < most)
      for (const Attempt& a : std::exchange(kept_, std::vector<Attempt>(4 * kept_.size())))
        kept_[place(a)] = a;
    kept_[place(attempt)] = attempt;
  }

private:
  static constexpr size_t most = size_t{1} << 14;

  size_t place(const Attempt& x) const {
    const auto join = [](auto high, auto low) { return uint64_t(uint32_t(high)) << 32 | uint32_t(low); };
    uint64_t h = (join(x.a, x.b) + uint32_t(x.element)) * 0x9E3779B97F4A7C15u;
    h ^= join(x.at_a, x.at_b) * 0xC2B2AE3D27D4EB4Fu;
    h ^= join(std::bit_cast<uint32_t>(x.goal), uint32_t(x.operation) << 8 | x.aims) * 0xD6E8FEB86659FD93u;
    return static_cast<size_t>(h * 0xFF51AFD7ED558CCDu >> 40) & (kept_.size() - 1);
  }

  std::vector<Attempt> kept_ = std::vector<Attempt>(256);
  size_t added_ = 0;
};

} // namespace molmesh::optimize

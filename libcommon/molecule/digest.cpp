// digest.cpp — mixes the bits of what the field depends on, in order.
#include "molecule/digest.hpp"
#include <bit>

namespace molmesh {
namespace {

class Mixer {
public:
  void add(double v) { value_ = digest(value_, std::bit_cast<uint64_t>(v)); }
  void add(int64_t v) { value_ = digest(value_, static_cast<uint64_t>(v)); }
  void add(Vec3d v) {
    for (int a = 0; a < 3; ++a)
      add(v[a]);
  }
  uint64_t value() const { return value_; }

private:
  uint64_t value_ = 0;
};

} // namespace

uint64_t digest(const Hierarchy& h) {
  Mixer m;
  for (const Level& l : h.level) {
    m.add(static_cast<int64_t>(l.group.size()));
    for (const Group& g : l.group) {
      m.add(g.exponent);
      m.add(g.weight);
      m.add(g.begin);
      m.add(g.end);
    }
  }
  for (const Atom& a : h.atom) {
    m.add(a.center);
    m.add(a.radius);
  }
  for (const Body& b : h.body) {
    m.add(static_cast<int64_t>(b.shape));
    for (const Vec3d& v : {b.center, b.u, b.v})
      m.add(v);
    m.add(b.size);
    m.add(b.skin);
    m.add(b.atom);
  }
  return m.value();
}

} // namespace molmesh

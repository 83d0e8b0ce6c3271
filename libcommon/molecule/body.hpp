// body.hpp — bodies without atoms: sphere, capsule, cylinder, box, slab, each a convex core with a skin of an atom.
#pragma once
#include "geom/rigid.hpp"
#include <optional>
#include <string>
#include <string_view>

namespace molmesh {

/// Its surface is that of the shape, with edges rounded by `skin`: all places within `skin` of the core, which is
/// the shape made smaller by it. Its term is exp(κ(skin² - d²)), d the distance from the core: that of the nearest
/// of atoms of radius `skin` all over the core (docs/theory/field.md §7).
struct Body {
  enum class Shape : uint8_t { sphere, capsule, cylinder, box, slab };
  Shape shape = Shape::sphere;
  Vec3d center; ///< Å
  Vec3d u,
      v; ///< Å. Capsule: from center to an end of its segment; cylinder: to the middle of a face; box: to the
         ///< middles of two faces, perpendicular; slab: to the middle of a wide face, which is square. Otherwise 0
  double size = 0;  ///< Å. Sphere, capsule, cylinder: radius; box: half its third edge; slab: half its width
  double skin = 0;  ///< Å, > 0, at most half of each thickness
  int64_t atom = 0; ///< entry of Hierarchy::atom that stands for it: name, center, radius = skin
};

/// "sphere", …, in the order of Body::Shape.
std::string_view shape_name(Body::Shape shape);
std::optional<Body::Shape> shape_of(std::string_view name);

/// Empty, or what of the numbers is wrong: "a skin of at most …".
std::string fault_of(const Body& b);

/// A slab, whose square follows the axes of the coordinates, becomes a box where it is turned.
Body moved(const Body& b, const Rigid& motion);

/// The convex core of a body, for distances.
class Core {
public:
  explicit Core(const Body& b);
  /// The place of the core nearest to p; p itself inside.
  Vec3d nearest(Vec3d p) const;
  double distance2(Vec3d p) const { return norm2(p - nearest(p)); }
  /// Corners of its box along the axes of the coordinates.
  Vec3d low() const { return center_ - extent_; }
  Vec3d high() const { return center_ + extent_; }

private:
  Vec3d center_, axis_[3], extent_;
  double half_[3] = {0, 0, 0}; ///< along the axes; of round ones the last alone counts
  double radius_ = 0;          ///< of round ones
  enum class Kind { capsule, cylinder, box } kind_;
};

} // namespace molmesh

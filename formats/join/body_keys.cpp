// body_keys.cpp — keys of each shape, and the body that they make.
#include "formats/join/body_keys.hpp"
#include "molecule/limits.hpp"
#include <algorithm>

namespace molmesh::formats {
namespace {

using Shape = Body::Shape;

const std::vector<const char*>& needed_keys(Shape shape) {
  static const std::vector<const char*> of_shape[] = {{"center", "radius"},
                                                      {"from", "to", "radius"},
                                                      {"from", "to", "radius"},
                                                      {"center", "edges"},
                                                      {"center", "normal", "thickness", "width"}};
  return of_shape[static_cast<size_t>(shape)];
}

Vec3d vector(const KeyValue& line) {
  return at(line.numbers({3}, "X,Y,Z (Å)"), 0);
}

double length(const KeyValue& line) {
  return line.number(0, 2 * largest_coordinate, "a length > 0 (Å)");
}

} // namespace

bool BodyKeys::take(const std::string& key, const KeyValue& line) {
  const std::vector<const char*>& needed = needed_keys(body_.shape);
  if (key != "skin" && std::find(needed.begin(), needed.end(), key) == needed.end())
    return false;
  if (std::find(given_.begin(), given_.end(), key) != given_.end())
    line.refuse("each key once, but for motions and copies");
  given_.push_back(key);
  if (key == "skin")
    body_.skin = length(line);
  else if (key == "center")
    body_.center = vector(line);
  else if (key == "from")
    from_ = vector(line);
  else if (key == "to")
    to_ = vector(line);
  else if (key == "normal")
    normal_ = vector(line);
  else if (key == "radius")
    body_.size = length(line);
  else if (key == "thickness")
    thickness_ = length(line);
  else if (key == "width")
    body_.size = length(line) / 2;
  else { // edges
    const Vec3d edges = vector(line);
    body_.u = {edges.x / 2, 0, 0};
    body_.v = {0, edges.y / 2, 0};
    body_.size = edges.z / 2;
  }
  return true;
}

Body BodyKeys::body(const std::string& where) {
  const std::string shape(shape_name(body_.shape));
  for (const char* key : needed_keys(body_.shape))
    if (std::find(given_.begin(), given_.end(), key) == given_.end())
      fail_input(where + ": found a " + shape + " without " + key + "=, expected it");
  if (body_.shape == Shape::capsule || body_.shape == Shape::cylinder) {
    body_.center = 0.5 * (from_ + to_);
    body_.u = 0.5 * (to_ - from_);
  } else if (body_.shape == Shape::slab) {
    if (!(norm(normal_) > 0))
      fail_input(where + ": found a normal of length 0, expected a direction");
    body_.u = 0.5 * thickness_ / norm(normal_) * normal_;
  }
  if (const std::string fault = fault_of(body_); !fault.empty())
    fail_input(where + ": found such a " + shape + ", expected " + fault);
  return body_;
}

} // namespace molmesh::formats

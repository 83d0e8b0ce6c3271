// body_keys.hpp — the keys by which a .join says what a body without atoms is.
#pragma once
#include "formats/plan/key_value.hpp"
#include "molecule/body.hpp"

namespace molmesh::formats {

class BodyKeys {
public:
  explicit BodyKeys(Body::Shape shape) { body_.shape = shape; }
  /// False: the key is none of this shape's.
  bool take(const std::string& key, const KeyValue& line);
  /// When all keys are taken. Throws Error(bad_input) "WHERE: …" where one is missing or the body is none.
  Body body(const std::string& where);

private:
  Body body_{Body::Shape::sphere, {}, {}, {}, 0, 1.7, 0};
  Vec3d from_, to_, normal_;
  double thickness_ = 0;
  std::vector<std::string> given_;
};

} // namespace molmesh::formats

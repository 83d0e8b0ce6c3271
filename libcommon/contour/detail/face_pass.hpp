// face_pass.hpp — the elements of the faces that a leaf owns, and the links they add to sign-change edges.
#pragma once
#include "contour/complex.hpp"
#include "contour/detail/batch.hpp"

namespace molmesh::contour::detail {

/// A face belongs to its smaller cell, of two equal ones to the lower. wanted[0]: outside, wanted[1]: inside.
void make_faces(const Complex& complex, int32_t leaf, const bool wanted[2], Batch& out);

} // namespace molmesh::contour::detail

// shaders/shared/look_uniforms.glsl as C++. The types have a namespace of their own and external linkage, so
// that kernels compiled for several instruction sets share them.
#pragma once

#include "core/shared_maths.h"

namespace astrosplat::shared_types {
using namespace astrosplat::glsl;
#include "look_uniforms.glsl"

// As std140 has them (OpenGL 4.1 specification, 2.11.4): structs and three-component vectors begin a row of
// 16 bytes.
template <class T>
inline constexpr bool has_whole_rows = sizeof(T) % 16 == 0;
static_assert(has_whole_rows<LookCurve> && has_whole_rows<LookProfile> && has_whole_rows<LookStop> &&
              has_whole_rows<LookNoise> && has_whole_rows<LookCrop> && has_whole_rows<LookAlpha> &&
              has_whole_rows<LookRadius> && has_whole_rows<LookGrade> && has_whole_rows<LookUniforms>);
static_assert(offsetof(LookStop, pdf) % 16 == 0 && offsetof(LookUniforms, alpha) % 16 == 0 &&
              offsetof(LookUniforms, vertical) % 16 == 0 && offsetof(LookUniforms, stops) % 16 == 0 &&
              offsetof(LookUniforms, noises) % 16 == 0 && offsetof(LookUniforms, crops) % 16 == 0);
}  // namespace astrosplat::shared_types

namespace astrosplat {
using shared_types::LookAlpha;
using shared_types::LookCurve;
using shared_types::LookEdge;
using shared_types::LookOutline;
using shared_types::LookProfile;
using shared_types::LookUniforms;

/// What looks need: the uniforms, and outlines with their edges.
struct PreparedLook : LookUniforms {
    std::vector<LookOutline> outlines;
    std::vector<LookEdge> edges;  // of all outlines

    bool is_cropped() const { return crop_count > 0 || !outlines.empty(); }
};
}  // namespace astrosplat

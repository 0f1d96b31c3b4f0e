// The look on the GPU: raw splats through look_splat of shaders/shared into shaded buffers, by
// transform feedback.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <memory>

#include "core/image.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "gl/splat_buffers.h"
#include "look/shared_uniforms.h"

namespace astrosplat {

/// What the loops of a shader run to that is made for the look at hand; by default what any look needs.
struct LookLimits {
    int stops = shared_types::LOOK_MAX_STOPS;
    int noises = shared_types::LOOK_MAX_NOISES;
    int points = shared_types::LOOK_MAX_POINTS;
    int octaves = 16;  // of a noise
    int crops = shared_types::LOOK_MAX_CROPS;
    auto operator<=>(const LookLimits&) const = default;
};

/// Small limits that hold this look, of few different ones, since each is a program to be compiled.
LookLimits limits_for(const LookUniforms& look);

struct LookPassInput {
    const LookUniforms& look;
    const Image* map = nullptr;  // raw values; read where there are several stops
};

class LookPass {
  public:
    LookPass();
    /// Writes all of `raw`, which holds them, to out[first], out[first + 1], ...
    void run(const RawSplats& raw, const LookPassInput& input, ShadedBuffers& out, std::int64_t first);

    /// The program for looks within these limits.
    static ProgramSource source_for(const LookLimits& limits);

  private:
    const GlProgram& program(const LookLimits& limits);
    void upload_map(const Image& map);

    std::map<LookLimits, std::unique_ptr<GlProgram>> programs_;  // compiled when first needed
    GlBuffer block_;
    GlTexture map_;
    GlTarget unused_;  // without a window OpenGL draws nothing where no target is bound
};

}  // namespace astrosplat

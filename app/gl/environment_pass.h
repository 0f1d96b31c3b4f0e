// The environment as the bottom of the frame: the two mip levels that a camera needs as textures, and a
// pass over the whole frame.
#pragma once

#include "camera/camera.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "render/environment.h"

namespace astrosplat {

/// The fragment stage of what draws the environment.
inline const std::vector<std::string> environment_fragment_files =
    after_projections({"environment_fragment.glsl"});

class EnvironmentPass {
  public:
    EnvironmentPass();
    /// Fills the bound target: colour of the environment, alpha 1.
    void draw(const Environment& environment, const Camera& camera);

  private:
    /// One mip level of all faces, uploaded where it is not the one already there.
    struct Level {
        GlTexture texture;
        const float* pixels = nullptr;  // of the first face, and some of what they held
        float probe = 0.0f;
        void hold(const Environment& environment, std::size_t level);
    };
    GlProgram program_;
    WholeTarget triangle_;
    Level fine_, coarse_;
};

}  // namespace astrosplat

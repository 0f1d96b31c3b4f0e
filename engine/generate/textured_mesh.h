// A mesh together with the pictures that colour it: what generation reads.
#pragma once

#include <vector>

#include "source/mesh.h"
#include "source/texture.h"

namespace astrosplat {

/// A mesh with one picture per material (exactly one where the texture was named in the scene).
struct TexturedMesh {
    Mesh mesh;
    std::vector<Texture> textures;
};

}  // namespace astrosplat

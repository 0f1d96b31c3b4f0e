// Pictures on planes, and splats at random places, as tests of bodies want them.
#pragma once

#include <glm/vec2.hpp>

#include "bodies/placement.h"
#include "core/shared_maths.h"
#include "source/textured_mesh.h"

namespace astrosplat {

inline Texture as_texture(const Image& rgb, float alpha = 1.0f) {
    Texture texture;
    texture.image = make_image(rgb.width, rgb.height, 4, alpha);
    for (std::int64_t i = 0; i < rgb.width * rgb.height; ++i)
        std::copy_n(rgb.pixels.data() + 3 * i, 3, texture.image.pixels.data() + 4 * i);
    return texture;
}

/// 10 units along its longer side.
inline TexturedMesh on_plane(const Image& rgb, float alpha = 1.0f) {
    TexturedMesh result;
    result.mesh = builtin_mesh("plane", double(rgb.width) / double(rgb.height));
    result.textures.push_back(as_texture(rgb, alpha));
    return result;
}

inline StructureParams of_kind(StructureKind kind) {
    StructureParams params;
    params.kind = kind;
    return params;
}

/// A block full of splats in a rectangle around a place of the picture, px; others of another number.
inline PlacedBlock splats_about(const glm::vec2& middle, const glm::vec2& size, std::uint32_t number) {
    PlacedBlock block;
    block.count = DepthBlock::size;
    for (int i = 0; i < block.count; ++i) {
        const auto id = number * DepthBlock::size + std::uint32_t(i);
        const auto random = [&](std::uint32_t purpose) { return shared::as_hash(8u, id, 0u, purpose); };
        block.x[i] = middle.x + size.x * (shared::as_uniform(random(1u)) - 0.5f);
        block.y[i] = middle.y + size.y * (shared::as_uniform(random(2u)) - 0.5f);
        block.random[i] = random(3u);
        block.even[i] = shared::as_uniform(random(4u));
    }
    return block;
}

}  // namespace astrosplat

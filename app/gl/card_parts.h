// What the rooms of Card share: card_draw.cpp (a group of a frame, whole or in parts), card_gather.cpp (its
// splats), card_memory.cpp, card_passes.cpp (its programs) and card_look.cpp.
#pragma once

#include "core/buffer.h"
#include "gl/card.h"
#include "splats/shaded_splats.h"

namespace astrosplat::card {

inline constexpr GLuint group_size = 256, scanned = 2048;  // of card_common.glsl and card_scan.glsl

/// The driver does not take one of our programs.
struct Failed : std::runtime_error {
    using std::runtime_error::runtime_error;
};

inline void barrier() {
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

inline void bind(std::initializer_list<const CardBuffer*> buffers) {
    for (GLuint at = 1; const CardBuffer* buffer : buffers) buffer->bind(at++);
}

inline std::int64_t groups_for(std::int64_t count, std::int64_t each) { return (count + each - 1) / each; }

/// Whether the processor projects all of the layer's splats.
inline bool is_given(const RenderLayer& layer) {
    return layer.stars || (layer.splats && !layer.splats->stretch.empty());
}

}  // namespace astrosplat::card

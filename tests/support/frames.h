// A pipeline's frames as the scene's own [output] has them.
#pragma once

#include "pipeline.h"

namespace astrosplat {

inline RenderSettings settings_of(const Pipeline& pipeline, double number) {
    return render_settings(pipeline.frame_scene(number).scene.output);
}

inline RenderedFrame frame_of(Pipeline& pipeline, double number) {
    return pipeline.frame(number, settings_of(pipeline, number));
}

}  // namespace astrosplat

// Editing the handles of Bezier keyframes (camera/keyframe.h): free functions on a scene's tracks. A
// parameter or a frame without a keyframe is left alone.
#pragma once

#include <string>
#include <vector>

#include "camera/keyframe.h"
#include "scene/scene.h"

namespace astrosplat {

enum class HandleSide { in, out };

/// Whether the segment at that side of keyframe i is Bezier.
bool has_handle(const Track& track, std::size_t i, HandleSide side);

/// Both handles of a keyframe. Free ones begin where they are.
void set_handle_kind(Scene& scene, const std::string& key, double frame, HandleKind kind);

/// Broken handles are moved one by one; joined again, the one before the keyframe follows the one after it.
void set_broken(Scene& scene, const std::string& key, double frame, bool broken);

/// Puts a handle at `frames` and `value` from its keyframe; frames on the other side of it count as 0. Both
/// become free; unless they are broken the other one keeps its frames and turns with this one, so that value
/// and speed go on evenly through the keyframe.
void set_handle(Scene& scene, const std::string& key, double frame, HandleSide side, double frames,
                const std::vector<double>& value);

}  // namespace astrosplat

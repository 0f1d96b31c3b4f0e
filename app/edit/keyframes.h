// Edits of a scene's animation: keyframes, and the handles of Bezier ones (camera/keyframe.h). Frames are
// whole unless dragged otherwise; a track that loses its last keyframe is removed and the parameter keeps the
// value it had there. Without such a track or keyframe nothing changes.
#pragma once

#include <string>
#include <vector>

#include "camera/keyframe.h"
#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

/// The track of a full parameter key; nullptr when it is not animated.
const Track* find_track(const Scene& scene, const std::string& key);
Track* find_track(Scene& scene, const std::string& key);
bool is_animated(const Scene& scene, const std::string& key);
bool has_keyframe_at(const Scene& scene, const std::string& key, double frame);

/// Adds or changes the keyframe at a frame. Throws InputError where the parameter cannot be animated or the
/// value does not fit.
void set_keyframe(Scene& scene, const std::string& key, double frame, const Value& value);
void remove_keyframe(Scene& scene, const std::string& key, double frame);
void remove_track(Scene& scene, const std::string& key);
/// Moves the keyframe at `from` to `to`, replacing one that is there.
void move_keyframe(Scene& scene, const std::string& key, double from, double to);
void copy_keyframe(Scene& scene, const std::string& key, double from, double to);
void set_interpolation(Scene& scene, const std::string& key, double frame, Interpolation interpolation);
void set_ends(Scene& scene, const std::string& key, Ends ends);

/// Frames of all keyframes of all tracks, ascending, each once; the nearest one before or after a frame (the
/// frame itself when there is none).
std::vector<double> frames_with_keyframes(const Scene& scene);
double frame_of_next_keyframe(const Scene& scene, double frame);
double frame_of_previous_keyframe(const Scene& scene, double frame);

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

// Editing the animation of a scene: free functions on its tracks. Frames are whole unless dragged otherwise;
// a track that loses its last keyframe is removed and the parameter keeps the value it had there.
#pragma once

#include <string>
#include <vector>

#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

/// The track of a full parameter key; nullptr when it is not animated.
const Track* find_track(const Scene& scene, const std::string& key);
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

}  // namespace astrosplat

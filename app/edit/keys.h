// Editing the animation of a scene: free functions on its tracks. Frames are whole unless dragged otherwise;
// a track that loses its last key is removed and the parameter keeps the value it had there.
#pragma once

#include <string>
#include <vector>

#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

/// The track of a full parameter key; nullptr when it is not animated.
const Track* find_track(const Scene& scene, const std::string& key);
bool is_keyed(const Scene& scene, const std::string& key);
bool has_key_at(const Scene& scene, const std::string& key, double frame);

/// Adds or changes the key at a frame. Throws InputError where the parameter cannot be animated or the value
/// does not fit.
void set_key(Scene& scene, const std::string& key, double frame, const Value& value);
void remove_key(Scene& scene, const std::string& key, double frame);
void remove_track(Scene& scene, const std::string& key);
/// Moves the key at `from` to `to`, replacing one that is there.
void move_key(Scene& scene, const std::string& key, double from, double to);
void copy_key(Scene& scene, const std::string& key, double from, double to);
void set_interpolation(Scene& scene, const std::string& key, double frame, Interpolation interpolation);
void set_ends(Scene& scene, const std::string& key, Ends ends);

/// Frames of all keys of all tracks, ascending, each once; the nearest one before or after a frame (the frame
/// itself when there is none).
std::vector<double> key_frames(const Scene& scene);
double next_key_frame(const Scene& scene, double frame);
double previous_key_frame(const Scene& scene, double frame);

}  // namespace astrosplat

// The [animation] table: tracks from TOML and back.
#pragma once

#include <string>

#include "scene/entries.h"
#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

/// Reads one track and checks it against the parameter it animates. Lists of the scene grow where a key names
/// their next element (noise.cull where no noise is set). `place` begins every message. Throws InputError.
Track read_track(const ParameterKey& key, const toml::node& node, Scene& scene, const std::string& place);

/// Reads all of [animation], in the order of the file.
std::vector<Track> read_tracks(const toml::table& table, Scene& scene, const std::string& file);

/// "{ keys = [[1, 0.5], ...], interpolation = "smooth" }"
std::string track_to_toml(const Track& track, const ParameterSpec& spec);

}  // namespace astrosplat

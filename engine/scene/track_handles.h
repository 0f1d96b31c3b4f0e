// The handles of a keyframe as scenes write them, the fourth part of
//
//     [frame, value, "bezier", { in = [-8, 0.2], out = "flat", broken = true }]
//
// in and out are "auto" (also where they are left out), "flat", or [frames, value] from the keyframe, with as
// many numbers as its value has; "flat" in place of the table is both. They shape the Bezier segments before
// and after the keyframe; broken: a person shapes them one by one.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "camera/keyframe.h"
#include "core/error.h"
#include "scene/parameter_key.h"
#include "scene/toml_read.h"

namespace astrosplat {

/// Where a track stands, for messages.
struct TrackPlace {
    std::string place;
    ParameterKey key;
    [[noreturn]] void fail(const std::string& message) const {
        throw InputError(fmt::format("{}: {}: {}", place, key, message));
    }
};

/// Reads them into a keyframe that has its value. Throws InputError.
void read_handles(const toml::node& node, Keyframe<std::vector<double>>& keyframe, const TrackPlace& at);

/// Empty where both are automatic.
std::string handles_to_toml(const Keyframe<std::vector<double>>& keyframe);

}  // namespace astrosplat

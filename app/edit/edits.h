// Building blocks of edits of a scene. Rules that every edit keeps: the scene can be saved and read again,
// values that depend on the edited ones follow, and what a drag makes is rounded to digits that a person
// would type. Then keyframes, and the handles of Bezier ones (camera/keyframe.h): frames are whole unless
// dragged otherwise; a track that loses its last keyframe is removed and the parameter keeps the value it had
// there; without such a track or keyframe nothing changes.
#pragma once

#include <fmt/format.h>

#include "camera/keyframe.h"
#include "core/error.h"
#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

/// Calls `act` and returns its result. A ValueError becomes an InputError, which names the parameter.
template <class Act>
auto naming(const ParameterKey& key, const Act& act) {
    try {
        return act();
    } catch (const ValueError& error) {
        throw InputError(fmt::format("{}: {}", key, error.what()));
    }
}

/// Takes out tracks whose parameter is gone (a noise entry or layer that was removed), then checks everything
/// that loading the saved scene would check. Throws InputError; `name` begins the messages that have no
/// better place.
void check_edited_scene(Scene& scene, const std::string& name);

/// Writes the values of the scene's output.preset, of [output] and [camera], into the scene; nothing where it
/// names none. Throws InputError.
void apply_output_preset(Scene& scene);

/// Makes the frame of a dome master square again where one side of it was changed, by that side.
void keep_dome_square(Scene& scene, const Scene& before);

/// Frames of ten seconds: the length of a film that was given none.
double film_frames(const OutputParams& output);

/// A still's first keyframe at a later frame makes it a film of film_frames(), or up to that keyframe.
/// Changes nothing where the edit itself chose frames, or where keyframes lay elsewhere before it.
void film_still(const Scene& before, Scene& after);

/// First and last frame of [output] frames; 1, 1 where they cannot be read.
struct FrameRange {
    double first = 1.0, last = 1.0;
};
FrameRange frame_range(const OutputParams& output);
/// Those that the timeline shows: of a still as many as it has once something moves.
FrameRange shown_range(const Scene& scene);

/// `value` without the digits that a step this small cannot mean.
double rounded_to_step(double value, double step);

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

/// The value comes to rest at the keyframe (in) or leaves it slowly (out): a flat handle of a Bezier segment,
/// which the one at that side becomes. Nothing where there is none. The handle at the other side stays, and
/// so, unless it is flat too, the two are broken.
void ease(Scene& scene, const std::string& key, double frame, HandleSide side);

/// Broken handles are moved one by one; joined again, the one before the keyframe follows the one after it.
void set_broken(Scene& scene, const std::string& key, double frame, bool broken);

/// Puts a handle at `frames` and `value` from its keyframe; frames on the other side of it count as 0. Both
/// become free; unless they are broken the other one keeps its frames and turns with this one, so that value
/// and speed go on evenly through the keyframe.
void set_handle(Scene& scene, const std::string& key, double frame, HandleSide side, double frames,
                const std::vector<double>& value);

}  // namespace astrosplat

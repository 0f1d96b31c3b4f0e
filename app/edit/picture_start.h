// The first scene of a picture that is opened in the window, and its making again in another way.
#pragma once

#include "core/atomic_file.h"
#include "edit/document.h"
#include "edit/view_state.h"
#include "scene/detail_tiles.h"
#include "sets/kept.h"

namespace astrosplat {

/// The text of a scene `place` around start.picture, as start.as, film and parted have it; fills the rest.
/// Stars that are parted go to a table beside `place`, NAME_stars.csv; one that lies there is taken. Reads
/// the picture, and with a film makes its detail. Throws InputError, OutputError, Cancelled.
std::string picture_start_text(PictureStart& start, const fs::path& place, const SetCache& cache = {},
                               const Progress& progress = {});

/// A small scene, seen from aside by parallel rays, in which its picture is taken for that: of so few splats
/// that it is made in about a second. Throws InputError, Cancelled.
Scene scene_from_aside(const fs::path& picture, SkyObject as, const Progress& progress = {});

/// "seen at 62 degrees", "seen face-on", by the first galaxy or the axis of a scene that was taken for
/// `object`; empty where neither is inclined.
std::string seen_in_words(const Scene& scene, SkyObject object);

/// Whether a document is as it began but for how its galaxies and axes lie.
bool only_lies_otherwise(const Document& document);

/// The stars that are on `picture` alone, or that it has beside `starless`, as a table for a layer of stars.
/// Throws InputError, OutputError, Cancelled.
void write_star_table(const fs::path& picture, const fs::path& starless, const fs::path& table,
                      Existing existing, const Progress& progress = {});

/// The text of a scene with a camera move, with the detail that this one needs. Throws as set_detail does.
struct FilmText {
    std::string text;
    std::vector<LayerDetail> detail;
};
FilmText with_detail(const std::string& text, const fs::path& place, const SetCache& cache,
                     const Progress& progress = {});

/// What start_again() with that choice does: "Taken for a nebula", "Half size".
std::string choice_in_words(const std::string& choice);

/// How likely that is, 0..1, and all kinds, the likeliest first.
double share_of(const PictureStart& start, SkyObject object);
std::vector<SkyObject> kinds_by_share(const PictureStart& start);

/// Of a SkyObject: after "Taken for", and on a button.
struct ObjectWords {
    const char *with_article, *button;
};
const ObjectWords& kind_words(SkyObject object);

/// `start` with the choice of Command::start_again. Throws InputError for another.
PictureStart chosen_start(PictureStart start, const std::string& choice);

/// A picture that scenes are made around, not a catalogue in a FITS file.
bool is_picture(const fs::path& file);

}  // namespace astrosplat

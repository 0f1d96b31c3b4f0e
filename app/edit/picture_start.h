// The first scene of a picture that is opened in the window, and its making again in another way.
#pragma once

#include "edit/view_state.h"
#include "sets/kept.h"

namespace astrosplat {

/// The text of a scene `place` around start.picture, as start.as, film and parted have it; fills the rest.
/// Stars that are parted go to a table beside `place`, NAME_stars.csv; one that lies there is taken. Reads
/// the picture, and with a film makes its detail. Throws InputError, OutputError.
std::string picture_start_text(PictureStart& start, const fs::path& place, const SetCache& cache = {});

/// `start` with the choice of Command::start_again. Throws InputError for another.
PictureStart chosen_start(PictureStart start, const std::string& choice);

/// A picture that scenes are made around, not a catalogue in a FITS file.
bool is_picture(const fs::path& file);

}  // namespace astrosplat

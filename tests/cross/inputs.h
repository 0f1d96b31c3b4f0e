// The files that the scenes of crossings name, made once a process: a picture, splats of every format,
// catalogues, a camera's path and pictures of the sky. And a folder of sets that all of them share.
#pragma once

#include "sets/kept.h"

namespace astrosplat::test {

/// The path of an input: picture.ppm, small.ppm, shell.ppm, table.pda, native.splats, gaussians.ply,
/// catalogue.csv, stars.csv, way.chan, sky.ppm, face0.ppm to face5.ppm, field.ppm.
fs::path input(const std::string& name);

/// Sets are made once, however many scenes ask for them.
const SetCache& shared_sets();

}  // namespace astrosplat::test

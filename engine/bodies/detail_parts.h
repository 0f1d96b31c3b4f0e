// Splats below a picture's pixels (DETAIL 4). In: the picture without its stars and its finest band, where
// it has invented detail. Out: smaller splats in place of that band's, part by part, and what they are to
// show: the front's fit takes both.
#pragma once

#include "bodies/picture_splats.h"
#include "core/progress.h"

namespace astrosplat {

/// A part of the picture with so much detail everywhere in it that is not another part's.
struct DetailPart {
    int octaves = 1;
    Region region;  // texels, in which its splats lie
    Region shown;   // those and some more about them
    Image light;    // of `shown` without stars, 2^octaves pixels a texel
    Image stars;    // what these have there, a pixel a texel
    std::vector<SplatRange> ranges;
};

/// `light`: of the picture, with stars and without; `finest`: of the band that they take the place of. Throws
/// Cancelled; NotEnoughMemory, an InputError.
std::vector<DetailPart> add_detail(const Image& with_stars, const Image& light, const Image& finest,
                                   const Image& alpha, const StructureParams& params,
                                   const Placement& placement, const Opacity& opacity,
                                   const Progress& progress, PictureSplats& out);

}  // namespace astrosplat

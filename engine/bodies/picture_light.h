// The light of a picture as the stages of this folder take it apart: in all, and as a sum of smooth bands,
// fine to coarse (DEPTH 2). In: a texture; linear light without its stars. Out: images of its size; one a
// band, each non-negative and as round as its scale, together the picture.
#pragma once

#include "core/image.h"
#include "source/texture.h"

namespace astrosplat {

struct PictureLight {
    Image light;    // RGB, linear, premultiplied, >= 0; what is not a number is 0
    Image alpha;    // one channel, 0..1; without pixels where the picture is opaque everywhere
    int times = 1;  // of these, along a side, are a texel of a picture that was enlarged
};

/// `border`: share of the width over which light and alpha fade to 0 towards the picture's edges, 0..0.5.
PictureLight picture_light(const Texture& texture, double border);

/// The picture at `area` of its texels, but no less than so many px a side.
Image at_area(const Image& image, double area, double smallest_px);

struct Band {
    int index = 0;         // 0: the finest
    double blur = 0.0;     // px, standard deviation: it holds finer details; the coarsest: coarser ones
    double feature = 0.0;  // px, size of what it shows
};

/// The bands of a picture so wide: blurs of 1.2 px and on by twos, up to 80 px at a width of 1920 and in
/// proportion.
std::vector<Band> make_bands(std::int64_t width_px);

/// Splits `light` (three channels, >= 0) and hands each band's image to `visit`, finest first, each once.
/// With P_0 = light and P_k = min(P_k-1, mu (1 - deviation / (2 mean))), mu, mean and deviation those of
/// P_k-1 under the band's blur, the band is P_k-1 - P_k and the last one what remains: all are >= 0 and sum
/// to `light`, up to the rounding of the sum. The same bits with any number of threads.
/// `fill_holes`: dark details of 2 px and more are no darkness of the coarser bands, whose sum is then more
/// than `light` where something hides it. Peaks smaller than the blur do not make their surroundings dark.
void split_bands(Image light, const std::vector<Band>& bands, bool fill_holes,
                 const std::function<void(const Band&, const Image&)>& visit);

}  // namespace astrosplat

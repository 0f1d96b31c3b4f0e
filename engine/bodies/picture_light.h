// The light of a picture as the stages of this folder take it apart. In: a texture. Out: images of its size.
#pragma once

#include "core/image.h"
#include "source/texture.h"

namespace astrosplat {

struct PictureLight {
    Image light;            // RGB, linear, premultiplied, >= 0; what is not a number is 0
    Image alpha;            // one channel, 0..1; without pixels where the picture is opaque everywhere
    bool enlarged = false;  // of a small picture, whose own texels are several of these
};

/// `border`: share of the width over which light and alpha fade to 0 towards the picture's edges, 0..0.5.
PictureLight picture_light(const Texture& texture, double border);

}  // namespace astrosplat

// What the options of `prepare` mean. In: words as typed. Out: numbers and pictures of masks, checked.
#pragma once

#include <optional>

#include "prepare.h"
#include "prepare/cut.h"
#include "prepare/lupton.h"
#include "prepare/star_field.h"
#include "source/source.h"

namespace astrosplat {

struct PrepareSettings {
    TextureSettings texture;  // how FITS is read
    StarSettings stars;       // saturation: infinite unless it was given
    bool three_filters = false;
    LuptonSettings lupton;
    std::optional<int> sky_degree;
    std::optional<CutEllipse> ellipse;
    std::optional<std::pair<double, double>> alpha;  // luminance of alpha 0 and 1
};

/// Throws InputError for what cannot be.
PrepareSettings prepare_settings(const PrepareOptions& options);

}  // namespace astrosplat

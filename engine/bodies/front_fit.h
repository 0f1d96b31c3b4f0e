// The front view made right (DEPTH 5): what is composited dims what lies deep, so colours are raised, step by
// step, by the ratio of the picture to what is seen. In and out: the splats of a picture. In between: their
// light from the front as if nothing hid anything, on grids of the picture's size and coarser ones, for a
// small part of what compositing them costs.
#pragma once

#include "bodies/detail_parts.h"
#include "bodies/picture_splats.h"
#include "core/image.h"
#include "core/progress.h"

namespace astrosplat {

struct FrontFit {
    int steps = 0;
    double psnr_db = 0.0;  // on sRGB values of every fourth row, as it is estimated from the rendering
};

/// Multiplies colours until the orthographic front view is the picture as the default pixel filter shows it;
/// last, cells of 32 px get the picture's flux. `small`: the picture was enlarged, its own texels are several
/// of these. The same bits with any number of threads. Throws Cancelled; InputError where memory does not
/// suffice. Then the splats of `detail` are taken on by themselves until their parts are as they should be.
FrontFit fit_front(PictureSplats& set, Image light, bool small = false, const Progress& progress = {},
                   std::span<const DetailPart> detail = {});

/// The ratio of the wanted light to the visible, of one channel: images of one size, > 0.
struct Fraction {
    Image wanted, seen;
};

class FlatLight {
  public:
    /// Of the splats that shine, over a picture of width x height texels seen through a Gaussian filter. The
    /// splats' places and sizes stay as they are while this lives.
    FlatLight(PictureSplats& set, std::int64_t width, std::int64_t height, double filter_px);

    /// The sum of all splats: three channels, of the picture's size. The same bits for any thread count.
    Image sum() const;

    /// Multiplies a channel of every splat's colour by the ratio of the two images of `fraction`, each
    /// blurred by half of the splat's own footprint, clamped to [1/3, 3]. `overshoot`: by its square, and
    /// fine splats once more by what it differs from the ratio of the pixels around. A channel at a time:
    /// pictures are large.
    void correct(Fraction fraction, int channel, bool overshoot);

    /// Multiplies every splat's colour by a value of `factor`, of three channels on steps of so many texels,
    /// linear between them.
    void multiply(const Image& factor, double step);

  private:
    struct Chunk {
        std::size_t begin, end;  // splats
        float top, bottom;       // of their places, texels
    };
    struct Range {
        double sigma;  // texels
        std::vector<Chunk> chunks;
    };
    struct Grid {
        std::int64_t width, height;
        double step;  // texels, a power of two
    };

    void add_range(const SplatRange& splats);
    std::size_t grid_for(double variance) const;
    bool has_few(const Range& range, const Grid& seen) const;
    glm::vec2 texel(std::size_t splat) const;
    void spread(const Range& range, double step, Image& sum) const;
    void multiply(const Range& range, const Image& factor, int channel, double step);

    PictureSplats& set_;
    glm::vec2 middle_;           // of the picture, texels
    double filter_variance_;     // texels^2
    std::vector<Grid> grids_;    // fine to coarse
    std::vector<Range> ranges_;  // in order of their sigmas
};

}  // namespace astrosplat

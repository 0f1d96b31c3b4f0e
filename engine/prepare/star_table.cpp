// Six digits tell more than any picture does.
#include "prepare/star_table.h"

#include <fmt/format.h>

namespace astrosplat {

std::string star_table(std::span<const PictureStar> stars, std::int64_t width, std::int64_t height) {
    std::string text = fmt::format("{}\nx,y,u,v,flux_r,flux_g,flux_b,sigma_px,saturated\n", star_table_mark);
    for (const PictureStar& star : stars) {
        text +=
            fmt::format("{:.3f},{:.3f},{:.7f},{:.7f},{:.6g},{:.6g},{:.6g},{:.4f},{}\n", star.x, star.y,
                        star.x / static_cast<double>(width), 1.0 - star.y / static_cast<double>(height),
                        star.flux(0), star.flux(1), star.flux(2), star.sigma_px(), star.saturated ? 1 : 0);
    }
    return text;
}

}  // namespace astrosplat

#include "splat_files/formats.h"

#include <fmt/format.h>

#include <glm/mat4x4.hpp>
#include <set>

#include "core/error.h"
#include "core/log.h"
#include "core/text.h"
#include "splat_files/file_bytes.h"
#include "splat_files/gaussian_rows.h"
#include "splat_files/number_text.h"
#include "usd/usda_stage.h"

namespace astrosplat {
namespace {

/// A .usda's text, and the file for messages.
struct UsdText {
    std::string_view text;
    std::string file;

    /// At a place within the text.
    [[noreturn]] void fail(const char* place, const std::string& expected, const std::string& found) const {
        bad_input(file, std::to_string(1 + std::count(text.data(), place, '\n')), expected, found);
    }
};

/// The numbers of a list, whatever tuples they stand in.
class NumberList {
  public:
    NumberList(const UsdText& text, std::string_view list)
        : text_(text), at_(list.data() + 1), end_(list.data() + list.size() - 1) {}

    /// False at the end.
    bool next(float& value) {
        while (at_ < end_ &&
               (scan::is_space(*at_) || *at_ == ',' || *at_ == '(' || *at_ == ')' || *at_ == '#'))
            at_ = *at_ == '#' ? std::find(at_, end_, '\n') : at_ + 1;
        if (at_ == end_) return false;
        const char* const after = scan::scan_float(at_, end_, value);
        if (!after) text_.fail(at_, "a number", shown({at_, std::find(at_, end_, '\n')}));
        at_ = after;
        return true;
    }

  private:
    const UsdText& text_;
    const char *at_, *end_;
};

constexpr const char* positions = "positions";
constexpr const char* coefficients = "radiance:sphericalHarmonicsCoefficients";

/// A prim that holds Gaussians.
struct GaussianPrim {
    const UsdPrim* prim = nullptr;
    GaussianPlacement placement;
    std::int64_t count = 0;
    int degree = 0;
    bool has_harmonics = false;  // else middle grey
};

/// Empty where the prim does not have it. Floats go before halves, whose names end in an h.
std::string_view list_of(const UsdPrim& prim, const std::string& name) {
    const std::string_view floats = prim.attribute(name).list;
    return floats.empty() ? prim.attribute(name + "h").list : floats;
}

std::int64_t tuples_in(const UsdText& text, std::string_view list, int components) {
    std::int64_t count = 0;
    NumberList numbers(text, list);
    for (float ignored; numbers.next(ignored);) ++count;
    if (count % components != 0)
        text.fail(list.data(), fmt::format("tuples of {} numbers", components), counted(count, "number"));
    return count / components;
}

/// The degree that the prim states, else the one its coefficients suffice for.
int degree_of(const UsdText& text, const GaussianPrim& own, std::string_view list) {
    const std::vector<double>& stated =
        own.prim->attribute("radiance:sphericalHarmonicsDegree").value.numbers;
    if (stated.size() == 1) {
        const double degree = stated[0];
        if (degree == 0.0 || degree == 1.0 || degree == 2.0 || degree == 3.0) return int(degree);
        text.fail(list.data(), "harmonics of degree 0 to 3", shortest(degree));
    }
    const std::int64_t each = own.count > 0 ? tuples_in(text, list, 3) / own.count : 0;
    return each >= 16 ? 3 : each >= 9 ? 2 : each >= 4 ? 1 : 0;
}

/// Nothing where it, or one above it, is invisible.
std::optional<GaussianPrim> prim_of(const UsdText& text, std::span<const UsdPrim* const> chain,
                                    const glm::dmat4& world) {
    const UsdPrim& prim = *chain.back();
    if (const std::string unread = left_out(chain); !unread.empty())
        log_warning(fmt::format("{}: {}", text.file, unread));
    std::set<double> times;
    for (const UsdPrim* const each : chain) add_times(*each, times);
    if (!times.empty())
        log_warning(fmt::format("{}: the motion of '{}' is not followed: it stands as at time code 0",
                                text.file, printable(prim.name)));
    for (const UsdPrim* const each : chain)
        if (each->attribute("visibility").value.is("invisible")) return {};
    GaussianPrim own;
    own.prim = &prim;
    const std::optional<GaussianPlacement> placement = gaussian_placement(world);
    if (!placement)
        bad_input(text.file, "prims that scale Gaussians alike along all axes",
                  fmt::format("others above '{}'", printable(prim.name)));
    own.placement = *placement;
    const std::string_view list = list_of(prim, positions);
    if (list.empty())
        bad_input(text.file, fmt::format("positions of '{}' (no time samples)", printable(prim.name)),
                  "none");
    own.count = tuples_in(text, list, 3);
    const std::string_view harmonics = list_of(prim, coefficients);
    own.has_harmonics = !harmonics.empty();
    if (own.has_harmonics) own.degree = degree_of(text, own, harmonics);
    return own;
}

/// Those below a prim that are defined, with `chain` from the stage's root to it.
void add_prims(const UsdText& text, const std::vector<UsdPrim>& prims, std::vector<const UsdPrim*>& chain,
               const glm::dmat4& above, std::vector<GaussianPrim>& all) {
    for (const UsdPrim& prim : prims) {
        if (!prim.defined) continue;
        chain.push_back(&prim);
        if (prim.type == usd_gaussians)
            if (const auto own = prim_of(text, chain, above * world_from_prim(chain, 0.0, text.file)))
                all.push_back(*own);
        add_prims(text, prim.children, chain, above, all);
        chain.pop_back();
    }
}

glm::dmat4 y_up_from(const UsdStage& stage) {
    glm::dmat4 m(1.0);
    if (!stage.is_z_up()) return m;
    m[1] = {0.0, 0.0, -1.0, 0.0};
    m[2] = {0.0, 1.0, 0.0, 0.0};
    return m;
}

std::vector<GaussianPrim> prims_of(const UsdText& text, const UsdStage& stage) {
    std::vector<GaussianPrim> all;
    std::vector<const UsdPrim*> chain;
    add_prims(text, stage.prims, chain, y_up_from(stage), all);
    if (all.empty())
        bad_input(text.file, fmt::format("visible Gaussians ({})", usd_gaussians), stage.none_found());
    return all;
}

/// Hands on each Gaussian's numbers; none where the prim has no such list. More than it has are left.
template <std::size_t kCount, class Take>
void read_list(const UsdText& text, const GaussianPrim& own, const std::string& name, const Take& take) {
    const std::string_view list = list_of(*own.prim, name);
    if (list.empty()) return;
    NumberList numbers(text, list);
    std::array<float, kCount> row;
    for (std::int64_t i = 0; i < own.count; ++i) {
        for (float& value : row)
            if (!numbers.next(value))
                text.fail(list.data(), fmt::format("{} of {}", own.count, name), std::to_string(i));
        take(std::size_t(i), row);
    }
}

void read_harmonics(const UsdText& text, const GaussianPrim& own, std::size_t first, SplatSet& set) {
    const std::string_view list = list_of(*own.prim, coefficients);
    NumberList numbers(text, list);
    const auto each = std::size_t((own.degree + 1) * (own.degree + 1));
    for (std::size_t i = 0; i < std::size_t(own.count); ++i)
        for (std::size_t j = 0; j < each; ++j) {
            glm::vec3 c;
            for (int k = 0; k < 3; ++k)
                if (!numbers.next(c[k]))
                    text.fail(list.data(),
                              fmt::format("{} harmonics of each of {}", each, counted(own.count, "Gaussian")),
                              std::to_string(each * i + j));
            (set.harmonics.empty() ? set.color[first + i] : set.harmonics[first + i].c[j]) = c;
        }
}

void read_prim(const UsdText& text, const GaussianPrim& own, std::size_t first, SplatSet& set) {
    const std::size_t end = first + std::size_t(own.count);
    std::fill(set.scale.begin() + first, set.scale.begin() + end, glm::vec3(1.0f));
    std::fill(set.rotation.begin() + first, set.rotation.begin() + end, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    std::fill(set.alpha.begin() + first, set.alpha.begin() + end, 1.0f);
    std::fill(set.color.begin() + first, set.color.begin() + end, glm::vec3(0.0f));
    read_list<3>(text, own, positions, [&](std::size_t i, const auto& v) {
        set.position[first + i] = {v[0], v[1], v[2]};
    });
    read_list<3>(text, own, "scales", [&](std::size_t i, const auto& v) {
        set.scale[first + i] = {v[0], v[1], v[2]};
    });
    read_list<4>(text, own, "orientations", [&](std::size_t i, const auto& v) {
        set.rotation[first + i] = {v[1], v[2], v[3], v[0]};
    });
    read_list<1>(text, own, "opacities", [&](std::size_t i, const auto& v) { set.alpha[first + i] = v[0]; });
    if (own.has_harmonics) read_harmonics(text, own, first, set);
    place_gaussians(set, first, end, own.placement);
}

/// The result of read(text, all) for a file.
template <class Read>
auto read_prims(const fs::path& file, const Read& read) {
    return read_mapped(file, [&](std::string_view bytes) {
        const UsdText text{bytes, file.string()};
        const UsdStage stage = parse_usda(bytes, text.file);
        return read(text, prims_of(text, stage));
    });
}

}  // namespace

SplatSet read_usda_splats(const fs::path& file, const Progress& progress) {
    return read_prims(file, [&](const UsdText& text, const std::vector<GaussianPrim>& all) {
        return read_gaussian_parts(all, {.trained = false, .display = true}, file, progress,
                                   [&](const GaussianPrim& own, std::size_t first, SplatSet& set) {
                                       read_prim(text, own, first, set);
                                   });
    });
}

SplatColumns usda_splat_columns(const fs::path& file) {
    return read_prims(file, [](const UsdText&, const std::vector<GaussianPrim>& all) {
        return gaussian_set_columns(is_directional(all));
    });
}

std::int64_t usda_splat_count(const fs::path& file) {
    return read_prims(file, [](const UsdText&, const std::vector<GaussianPrim>& all) {
        std::int64_t count = 0;
        for (const GaussianPrim& own : all) count += own.count;
        return count;
    });
}

}  // namespace astrosplat

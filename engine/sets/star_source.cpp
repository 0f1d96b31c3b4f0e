#include "sets/load_source.h"

#include <fmt/format.h>

#include <numeric>

#include "bodies/star_places.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/shared_maths.h"
#include "core/text.h"
#include "generate/lattice.h"
#include "stars/catalogue.h"
#include "stars/star_set.h"

namespace astrosplat {
namespace {

// ", 12 k WHAT" of a summary; nothing where there are none.
std::string also(std::int64_t count, const std::string& what) {
    return count > 0 ? ", " + human_count(double(count)) + " " + what : "";
}

std::string too_faint_text(std::int64_t count, const StarsParams& stars) {
    return also(count, fmt::format("fainter than magnitude {} left out", stars.limit));
}

template <class Star>
void warn_of_bad_rows(const StarRows<Star>& table, const StarsParams& stars, const std::string& layer_name) {
    if (table.bad.count > 0)
        log_warning(fmt::format("layer '{}': {}: {}", layer_name, stars.catalogue.string(),
                                table.bad.text(table.rows)));
}

StarCatalogue read_catalogue_of(const StarsParams& stars, const std::string& layer_name,
                                const Progress& progress) {
    StarCatalogue catalogue = read_catalogue(stars.catalogue, progress);
    warn_of_bad_rows(catalogue, stars, layer_name);
    return catalogue;
}

StarScale scale_of(const StarsParams& stars) {
    return {stars.unit.value_or(1.0), stars.limit, stars.zero_point};
}

SplatSet scatter_stars(const SourceParams& source, const std::string& layer_name, const Progress& progress) {
    const StarsParams& stars = source.stars;
    if (stars.path.empty()) throw InputError("expected a camera with a position for its stars, found none");
    const bool from_catalogue = !stars.catalogue.empty();
    const std::vector<StarKind> kinds =
        from_catalogue ? kinds_of(read_catalogue_of(stars, layer_name, progress), stars.limit)
                       : main_sequence();
    if (kinds.empty())
        bad_input(stars.catalogue,
                  fmt::format("stars of magnitude {} or brighter with a distance", stars.limit), "none");
    log_info(fmt::format("layer '{}': {} within {:.4g} of the camera's path, of {}", layer_name,
                         human_count(source.count, "random star"), stars.spread,
                         from_catalogue
                             ? human_count(std::int64_t(kinds.size()), "star") + " of the catalogue"
                             : "the main sequence"));
    return random_stars({stars.path, stars.spread}, kinds, source.count,
                        resolved_seed(source.seed, layer_name), scale_of(stars), progress);
}

SplatSet read_stars(const StarsParams& stars, const std::string& layer_name, const Progress& progress) {
    const StarCatalogue catalogue = read_catalogue_of(stars, layer_name, progress);
    StarCounts counts;
    SplatSet set = star_set(catalogue, scale_of(stars), &counts);
    log_info(fmt::format("layer '{}': {}{}{}", layer_name, human_count(counts.kept, "star"),
                         too_faint_text(counts.too_faint, stars),
                         also(counts.infinite, "without a distance at infinity")));
    return set;
}

// Without the stars that are too faint, which are counted.
PictureTable bright_stars(const StarsParams& stars, const std::string& layer_name, const Progress& progress,
                          std::int64_t& too_faint) {
    PictureTable table = read_picture_table(stars.catalogue, progress);
    warn_of_bad_rows(table, stars, layer_name);
    const double least = star_flux(stars.limit, stars.zero_point);
    too_faint = std::int64_t(
        std::erase_if(table.stars, [&](const TableStar& star) { return star.luminance() < least; }));
    return table;
}

// Which share of all stars lies before each: at random, or as many as are brighter.
std::vector<SeenStar> seen_stars(const std::vector<TableStar>& table, const SourceParams& source,
                                 std::uint32_t seed, const glm::dvec2& times) {
    std::vector<SeenStar> seen;
    for (const TableStar& star : table) {
        const std::uint32_t hash =
            shared::as_hash_of_id(seed, std::uint64_t(star.row), shared::PURPOSE_DEPTH);
        seen.push_back({glm::vec2((star.uv - 0.5) / times + 0.5), shared::as_uniform(hash)});
    }
    if (source.stars.depth != StarsParams::Depth::magnitude) return seen;
    std::vector<std::size_t> order(table.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return table[i].luminance(); });
    for (std::size_t i = 0; i < order.size(); ++i)
        seen[order[i]].before = (float(i) + 0.5f) / float(order.size());
    return seen;
}

// The picture as its layer has it, and how the table's pixels lie in it.
struct PictureOfStars {
    TexturedMesh mesh;
    StarDepths depths;
    glm::dvec2 times{1.0};       // as wide and high as the table's
    double texels_per_px = 1.0;  // of the table's
};

PictureOfStars picture_of(const SourceParams& source, const std::string& layer_name, const Progress& progress,
                          const PictureMaker& prepared) {
    const SourceParams picture = picture_source(source);
    std::vector<TexturedMesh> meshes =
        load_meshes(picture, progress.silent(), {prepared, {}, most_texels_read(picture, room_for_bodies())});
    const double slab = source.stars.slab;
    if (meshes.empty() || !shown_picture(meshes.front()))
        throw InputError(
            fmt::format("expected a picture on the first mesh of layer '{}', found none", source.stars.like));
    const Texture& whole = *shown_picture(meshes.front());
    const double width_px = double(whole.file_width > 0 ? whole.file_width : whole.image.width);
    PictureOfStars result;
    if (picture.structure.kind == StructureKind::columns) {
        const double reach = resolved_max_distance(picture, bounds(meshes));
        result = {std::move(meshes.front()), {slab > 0.0 ? slab : 2.0 * reach, {}, 1}, {1.0, 1.0}, 1.0};
    } else {
        BodiesPlan plan = plan_bodies(picture, std::move(meshes), layer_name);
        result = {std::move(plan.meshes.front()),
                  {slab, plan.structure, source.stars.like_seed},
                  plan.times.empty() ? glm::dvec2(1.0) : plan.times.front(),
                  1.0};
    }
    const double width = double(shown_picture(result.mesh)->image.width);
    result.texels_per_px = width / (result.times.x * width_px);
    return result;
}

StarPixels pixels_of(const PlacedStars& placed, double texels_per_px) {
    StarPixels pixels;
    pixels.from = placed.camera.eye;
    const bool parallel = placed.camera.projection == Projection::orthographic;
    (parallel ? pixels.side : pixels.side_at_1) = placed.texel_side * texels_per_px;
    return pixels;
}

SplatSet set_of(const PlacedStars& placed, const std::vector<TableStar>& table,
                const std::vector<glm::dvec3>& passing) {
    SplatSet set = empty_star_set(std::int64_t(placed.star.size()));
    for (std::size_t i = 0; i < placed.star.size(); ++i) {
        const TableStar& star = table[placed.star[i]];
        const glm::dvec3 light = star.light * double(placed.texel_area[i]);
        set.position[i] = placed.position[i];
        set.color[i] = glm::vec3(passing.empty() ? light : light / passing[i]);
        set.distance[i] = placed.distance[i];
        set.id[i] = std::uint64_t(star.row);
        set.max_distance = std::max(set.max_distance, double(set.distance[i]));
    }
    return set;
}

}  // namespace

SourceParams picture_source(const SourceParams& source) {
    SourceParams picture = source;
    picture.kind = SourceKind::mesh;
    picture.seed = source.stars.like_seed;
    picture.stars = {};
    return picture;
}

SplatSet load_picture_stars(const SourceParams& source, const std::string& layer_name,
                            const Progress& progress, const PictureMaker& prepared,
                            const std::function<const SplatSet&()>& of_picture) {
    std::int64_t too_faint = 0;
    const PictureTable table = bright_stars(source.stars, layer_name, progress, too_faint);
    const PictureOfStars picture = picture_of(source, layer_name, progress, prepared);
    const std::vector<SeenStar> seen =
        seen_stars(table.stars, source, resolved_seed(source.seed, layer_name), picture.times);
    PlacedStars placed = place_stars(picture.mesh, seen, picture.depths);
    std::vector<glm::dvec3> passing;
    const bool bodies = source.structure.kind != StructureKind::columns;
    if (bodies && !placed.star.empty()) {
        constexpr double filter_px = 0.5;
        passing = passing_light(
            {placed.camera, placed.height_texels / picture.texels_per_px, filter_px, median_sigma_px(table)},
            of_picture(), placed.position, progress);
    }
    SplatSet set = set_of(placed, table.stars, passing);
    set.star_pixels = pixels_of(placed, picture.texels_per_px);
    const auto outside = std::int64_t(table.stars.size() - placed.star.size());
    log_info(fmt::format("layer '{}': {} of the picture of '{}'{}{}", layer_name,
                         human_count(set.size(), "star"), source.stars.like,
                         too_faint_text(too_faint, source.stars), also(outside, "outside of it left out")));
    return set;
}

SplatSet load_stars(const SourceParams& source, const std::string& layer_name, const Progress& progress,
                    const PictureMaker& prepared, const std::function<SplatSet()>& of_picture) {
    if (is_like_a_layer(source)) {
        SplatSet picture;
        return load_picture_stars(source, layer_name, progress, prepared, [&]() -> const SplatSet& {
            picture = of_picture();
            return picture;
        });
    }
    return source.stars.along.empty() ? read_stars(source.stars, layer_name, progress)
                                      : scatter_stars(source, layer_name, progress);
}

}  // namespace astrosplat

#include "scene/detail_tiles.h"

#include "bodies/bodies.h"
#include "bodies/uv_surface.h"
#include "camera/camera.h"
#include "camera/projection.h"
#include "scene/animate.h"
#include "scene/frames.h"
#include "scene/layer_setup.h"

namespace astrosplat {
namespace {

constexpr std::int64_t tile_texels = 64, most_tiles = 128;  // a side
constexpr double one_octave_px = 2.5, two_octaves_px = 5.0;
constexpr double splats_a_detail_px = 1.6;  // of the Pillars in full detail

struct TileGrid {
    std::int64_t columns, rows;
    double texels;                      // in each
    std::vector<double> texel_px = {};  // the most px of a frame that a texel of it is wide
};

TileGrid grid_of(const Texture& texture) {
    const bool reduced = texture.file_width > 0;
    const std::int64_t width = reduced ? texture.file_width : texture.image.width,
                       height = reduced ? texture.file_height : texture.image.height;
    const auto tiles = [](std::int64_t texels) {
        return std::clamp<std::int64_t>((texels + tile_texels - 1) / tile_texels, 1, most_tiles);
    };
    TileGrid grid{tiles(width), tiles(height), 0.0};
    grid.texels = double(width) * double(height) / double(grid.columns * grid.rows);
    grid.texel_px.resize(std::size_t(grid.columns * grid.rows), 0.0);
    return grid;
}

// A tile where it is on a mesh.
struct TilePlace {
    std::size_t tile;
    glm::dvec3 position;     // layer space
    double units_per_texel;  // of the picture's file
};

std::vector<TilePlace> places_of(const PictureOnMesh& picture, const TileGrid& grid) {
    const UvSurface surface = surface_of(*picture.mesh, picture.material);
    const Texture& texture = picture.texture();
    const double reduced =
        texture.file_width > 0 ? double(texture.image.width) / double(texture.file_width) : 1.0;
    std::vector<TilePlace> places;
    for (std::int64_t row = 0; row < grid.rows; ++row)
        for (std::int64_t column = 0; column < grid.columns; ++column) {
            const glm::vec2 uv((float(column) + 0.5f) / float(grid.columns),
                               1.0f - (float(row) + 0.5f) / float(grid.rows));
            surface.at(uv, [&](const SurfacePlace& place) {
                places.push_back({std::size_t(row * grid.columns + column), glm::dvec3(place.position),
                                  double(place.units_per_texel) * reduced});
            });
        }
    return places;
}

std::vector<std::int64_t> frames_looked_at(const std::string& frames) {
    constexpr std::size_t every = 4;
    const std::vector<std::int64_t> all = parse_frames(frames, "output.frames");
    std::vector<std::int64_t> some;
    for (std::size_t i = 0; i < all.size(); i += every) some.push_back(all[i]);
    if (!all.empty() && some.back() != all.back()) some.push_back(all.back());
    return some;
}

// Takes a frame's pixels into account.
void look_from(const Scene& now, const LayerParams& layer, const std::vector<TilePlace>& places,
               const Bounds& box, TileGrid& grid) {
    const auto width = double(now.output.width), height = double(now.output.height);
    const RenderLayer placed = render_layer(now, layer);
    const Camera camera = make_camera(now.camera, width, height, world_bounds(box, placed));
    const Lens lens = make_lens(camera);
    const glm::dmat3 camera_from_world = glm::transpose(camera.world_from_camera);
    const double half_tile = 0.5 * std::sqrt(grid.texels);  // texels
    for (const TilePlace& place : places) {
        const glm::vec3 p(camera_from_world * (placed.to_world(place.position) - camera.eye));
        const auto seen = shared::instance_of(lens, p);
        const double texel_px = double(seen.px_per_unit) * placed.scale * place.units_per_texel,
                     reach = half_tile * texel_px;
        if (!(double(seen.depth) > double(lens.near)) || !(double(seen.x_px) > -reach) ||
            !(double(seen.x_px) < width + reach) || !(double(seen.y_px) > -reach) ||
            !(double(seen.y_px) < height + reach))
            continue;
        grid.texel_px[place.tile] = std::max(grid.texel_px[place.tile], texel_px);
    }
}

// Of all tiles, by limits so many times as high.
std::vector<int> octaves_of(const TileGrid& grid, double limits) {
    std::vector<int> octaves;
    for (const double px : grid.texel_px)
        octaves.push_back(px > limits * two_octaves_px ? 2 : px > limits * one_octave_px ? 1 : 0);
    const auto at = [&](std::int64_t column, std::int64_t row) -> int& {
        return octaves[std::size_t(row * grid.columns + column)];
    };
    for (std::int64_t row = 0; row < grid.rows; ++row)
        for (std::int64_t column = 0; column < grid.columns; ++column)
            for (std::int64_t j = std::max<std::int64_t>(0, row - 1); j <= std::min(row + 1, grid.rows - 1);
                 ++j)
                for (std::int64_t i = std::max<std::int64_t>(0, column - 1);
                     i <= std::min(column + 1, grid.columns - 1); ++i)
                    if (at(i, j) == 2) at(column, row) = std::max(at(column, row), 1);
    return octaves;
}

double splats_of(const TileGrid& grid, const std::vector<int>& octaves) {
    double detail_px = 0.0;
    for (const int n : octaves)
        if (n > 0) detail_px += grid.texels * double(1 << (2 * n));
    return splats_a_detail_px * detail_px;
}

}  // namespace

DetailTiles detail_tiles(const Scene& scene, const LayerParams& layer, std::span<const TexturedMesh> meshes,
                         double most_splats) {
    const std::vector<PictureOnMesh> pictures = pictures_of(meshes);
    if (pictures.empty()) return {};
    TileGrid grid = grid_of(pictures.front().texture());
    std::vector<TilePlace> places;
    for (const PictureOnMesh& picture : pictures)
        for (const TilePlace& place : places_of(picture, grid)) places.push_back(place);
    for (const std::int64_t frame : frames_looked_at(scene.output.frames)) {
        const Scene now = scene_at(scene, double(frame));
        const auto here = std::ranges::find(now.layers, layer.name, &LayerParams::name);
        if (here->visible) look_from(now, *here, places, bounds(meshes), grid);
    }
    constexpr double higher = 1.1;  // DETAIL 4
    std::vector<int> octaves = octaves_of(grid, 1.0);
    for (double limits = higher; splats_of(grid, octaves) > most_splats; limits *= higher)
        octaves = octaves_of(grid, limits);
    DetailTiles found;
    found.more_splats = splats_of(grid, octaves);
    for (const int n : octaves) found.shares[n] += 1.0 / double(octaves.size());
    if (found.more_splats == 0.0) return found;
    for (std::size_t i = 0; i < octaves.size(); ++i) {
        if (i > 0 && std::int64_t(i) % grid.columns == 0) found.tiles += ' ';
        found.tiles += char('0' + octaves[i]);
    }
    return found;
}

bool has_bodies(const LayerParams& layer) {
    return layer.source.kind == SourceKind::mesh && layer.source.structure.kind != StructureKind::columns;
}

std::vector<LayerDetail> set_detail(Scene& scene, double most_splats, const SetCache& cache,
                                    const Progress& progress) {
    std::vector<LayerDetail> all;
    for (LayerParams& layer : scene.layers) {
        if (!has_bodies(layer)) continue;
        StructureParams& structure = layer.source.structure;
        structure.detail_tiles.clear();
        structure.detail = 0;
        DetailTiles found;
        if (most_splats > 0.0)
            found = detail_tiles(scene, layer, load_meshes(cache, layer.source, progress, enough_texels),
                                 most_splats);
        structure.detail_tiles = found.tiles;
        structure.detail = found.shares[2] > 0.0 ? 2 : found.shares[1] > 0.0 ? 1 : 0;
        all.push_back({layer.name, std::move(found)});
    }
    return all;
}

}  // namespace astrosplat

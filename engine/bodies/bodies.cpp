#include "bodies/bodies.h"

#include <fmt/format.h>

#include <numeric>

#include "bodies/axis_depths.h"
#include "bodies/axis_fit.h"
#include "bodies/detail_parts.h"
#include "bodies/dust.h"
#include "bodies/front_fit.h"
#include "bodies/picture_light.h"
#include "bodies/picture_splats.h"
#include "bodies/placement.h"
#include "bodies/spikes.h"
#include "bodies/stars.h"
#include "bodies/uv_surface.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/text.h"
#include "image/channels.h"
#include "image/resample.h"

namespace astrosplat {
namespace {

constexpr int most_faces = 64;  // that show one splat: ids hold 6 bits of which

glm::vec2 uv_of(const glm::vec3& texel, const Image& image) {
    return {texel.x / float(image.width) + 0.5f, texel.y / float(image.height) + 0.5f};
}

// The light of the first picture begins the sum.
void add(const Image& light, Image& sum) {
    if (sum.pixels.empty())
        sum = copied(light);
    else
        parallel_each(sum.pixels.size(), 65536, [&](std::size_t i) { sum.pixels[i] += light.pixels[i]; });
}

// What bodies are made of, for all pictures of a layer; each has a seed of its own.
struct BodiesTask {
    StructureParams params;
    std::uint32_t seed;
    const std::string& layer_name;
};

// The axis of a picture's nebula, or none where it has none: said in a line.
std::optional<AxisDepths> axis_of(const Image& light, const StructureParams& params,
                                  const std::string& layer_name) {
    if (params.kind != StructureKind::axis) return {};
    AxisFit fit = fit_axis(light, params);
    const std::string found = fmt::format("layer '{}': {}", layer_name, symmetry_words(fit));
    if (!is_about_axis(fit)) {
        log_warning(found + ", too little: walls are made instead");
        return {};
    }
    log_detail(fmt::format("{}; axis at {:.1f} degrees, tilted by {:.0f}{}", found, real::degrees(fit.angle),
                           fit.tilt_deg, fit.tilt_is_sure() ? "" : ", which is a guess"));
    return make_axis_depths(std::move(fit), light);
}

// Adds all splats of a picture, with their colours as they would be if nothing hid anything. Out: the parts
// that have invented detail.
std::vector<DetailPart> add_splats(const PictureLight& picture, const UvSurface& surface,
                                   const BodiesTask& task, const Progress& progress, PictureSplats& set) {
    StructureParams params = task.params;
    Image rest = copied(picture.light);
    const bool takes_stars = params.stars != StructureParams::Stars::no;
    Spikes spikes = takes_stars ? take_spikes(rest, picture.times, &picture.light) : Spikes();
    release_spare_pages();  // of finding them
    progress.at(0.25);
    const PictureStars stars =
        take_picture_stars(rest, params, picture.times > 1, std::move(spikes.gaussians));
    progress.at(0.3);
    std::optional<AxisDepths> axis = axis_of(rest, params, task.layer_name);
    if (params.kind == StructureKind::axis && !axis) params.kind = StructureKind::walls;
    const double dust = dust_of(params);
    const Image without_stars = dust > 0.0 ? brightest_channel(rest) : Image();
    Placement placement = make_placement(rest, params, surface.texels_per_unit(), surface.flat(), task.seed,
                                         stars.all, std::move(axis));
    progress.at(0.45);
    const Opacity opacity{float(params.opacity), float(params.density)};
    const std::vector<Band> bands = make_bands(rest.width);
    Image emission;  // of all bands, where there is dust
    const bool detailed = placement.detail.any();
    const Image all_bands = detailed ? copied(rest) : Image();
    std::vector<DetailPart> detail;
    release_spare_pages();  // of reading and of the fields: bands and their splats are the most there is
    split_bands(std::move(rest), bands, dust > 0.0, [&](const Band& band, const Image& light) {
        progress.check();
        release_spare_pages();  // of splitting: there are more splats before it is done again
        if (dust > 0.0) add(light, emission);
        const bool coarsest = band.index + 1 == int(bands.size());
        for (const BandSplats& size : band_splats(band, coarsest, placement))
            add_band(whole_band(light), size, picture.light, picture.alpha, placement, opacity, set);
        if (detailed && band.index == 0)
            detail = add_detail(picture.light, all_bands, light, picture.alpha, params, placement, opacity,
                                progress.part(0.45, 0.55), set);
        if (none_in_knots(std::span(bands).subspan(std::size_t(band.index) + 1), placement))
            placement.knots = {};  // two numbers a texel
        progress.at(0.55 + 0.4 * (band.index + 1.0) / double(bands.size()));
    });
    if (dust > 0.0)
        add_dust(transmittance_of(without_stars, emission, picture.alpha), dust,
                 dust_exponents_of(picture.light), placement, set);
    add_picture_stars(stars, placement, opacity, set);
    add_spikes(spikes.light, places_of(spikes.stars), 0, picture.times, placement, opacity, set);
    add_spikes(stars.rest, places_of(stars.all), 1, 1, placement, opacity, set);
    if (spikes.arms > 0)
        log_detail(fmt::format("layer '{}': {} with {} spikes each, at {:.1f} degrees; {} splats",
                               task.layer_name, counted(std::ssize(spikes.stars), "star"), spikes.arms,
                               real::degrees(spikes.angle), human_count(double(spikes.light.size()))));
    log_detail(fmt::format("layer '{}': {} splats and {} in {}", task.layer_name,
                           human_count(double(set.splats.size())), counted(stars.count, "star"),
                           counted(std::int64_t(bands.size()), "band")));
    return detail;
}

constexpr std::int64_t rows_per_task = 16384;

// How many faces show each splat.
Buffer<std::uint8_t> faces_of(const PictureSplats& set, const UvSurface& surface, const Image& image) {
    Buffer<std::uint8_t> faces(set.splats.position.size());
    parallel_each(faces.size(), rows_per_task, [&](std::size_t i) {
        const int found = surface.faces_at(uv_of(set.splats.position[i], image));
        faces[i] = static_cast<std::uint8_t>(std::min(found, most_faces));
    });
    return faces;
}

// Every value as often as `first` has rows for it.
template <class T>
void repeat(Buffer<T>& values, const Buffer<std::int64_t>& first) {
    Buffer<T> rows(std::size_t(first.back()));
    parallel_each(values.size(), rows_per_task, [&](std::size_t i) {
        std::fill(rows.begin() + first[i], rows.begin() + first[i + 1], values[i]);
    });
    values = std::move(rows);
}

// One row for every face that shows a splat; the id says which of them.
void repeat_by_faces(const Buffer<std::uint8_t>& faces, PictureSplats& set) {
    if (std::ranges::all_of(faces, [](std::uint8_t n) { return n == 1; })) return;
    Buffer<std::int64_t> first(faces.size() + 1);
    first[0] = 0;
    for (std::size_t i = 0; i < faces.size(); ++i) first[i + 1] = first[i] + faces[i];
    for_each_array(set.splats, [&](auto& values) { repeat(values, first); });
    repeat(set.distance, first);
    parallel_each(faces.size(), rows_per_task, [&](std::size_t i) {
        for (std::int64_t n = 0; n < faces[i]; ++n)
            set.splats.id[first[i] + n] |= std::uint64_t(n) << instance_bit;
    });
}

SurfacePlace place_of_row(const UvSurface& surface, glm::vec2 uv, std::uint64_t id) {
    std::uint64_t face = id >> instance_bit & (most_faces - 1);
    SurfacePlace found;
    surface.at(uv, [&](const SurfacePlace& place) {
        if (face-- == 0) found = place;
    });
    return found;
}

// Brings a row whose place and sizes are in texels to its place on the mesh.
void put_on_surface(const UvSurface& surface, const PictureOnMesh& picture, std::uint64_t number,
                    std::size_t row, SplatSet& set) {
    const glm::vec3 p = set.position[row];
    const glm::vec2 uv = uv_of(p, picture.texture().image);
    const SurfacePlace place = place_of_row(surface, uv, set.id[row]);
    const float z = along_rays(place, p.z);
    const float scale = place.units_per_texel * (1.0f - place.approach * z);  // nearer splats are smaller
    set.position[row] = place.position + place.rise * (z * place.units_per_texel);
    set.distance[row] *= scale;
    set.radius[row] *= scale;
    set.id[row] |= number << picture_bit;
    set.uv[row] = uv;
    set.normal[row] = place.normal;
    set.mesh[row] = picture.mesh_index;
}

// The splats on the mesh, in the memory that they have.
SplatSet on_mesh(PictureSplats made, const Buffer<std::uint8_t>& faces, const UvSurface& surface,
                 const PictureOnMesh& picture, std::uint64_t number) {
    repeat_by_faces(faces, made);
    SplatSet set;
    set.position = std::move(made.splats.position);
    set.color = std::move(made.splats.color);
    set.alpha = std::move(made.splats.alpha);
    set.radius = std::move(made.splats.radius);
    set.id = std::move(made.splats.id);
    set.distance = std::move(made.distance);
    set.uv.resize(set.position.size());
    set.normal.resize(set.position.size());
    set.mesh.resize(set.position.size());
    parallel_each(set.position.size(), rows_per_task,
                  [&](std::size_t row) { put_on_surface(surface, picture, number, row, set); });
    return set;
}

// Puts rows behind those that are there.
void append(SplatSet rows, SplatSet& set) {
    for_each_column([&]<class T>(Buffer<T> SplatSet::*column, SplatColumn) {
        Buffer<T>& all = set.*column;
        if (all.empty())
            all = std::move(rows.*column);
        else
            all.insert(all.end(), (rows.*column).begin(), (rows.*column).end());
        rows.*column = Buffer<T>();
    });
}

// Splats before the fit, and how many faces show each.
struct MadeSplats {
    PictureSplats set;
    Buffer<std::uint8_t> faces;
    Image light;  // of the picture that they are to show
    std::vector<DetailPart> detail;
};

constexpr double most_expected = 1.08;  // times as many splats as are expected

// Takes the texture's pixels, unless they might be wanted again.
MadeSplats made_of(Texture& texture, const UvSurface& surface, const BodiesTask& task, double expected,
                   bool once_more, const Progress& progress) {
    PictureLight picture = picture_light(texture, task.params.border);
    if (!once_more) texture.image.pixels = Buffer<float>();
    release_spare_pages();  // or splats that are not made yet would hold some
    MadeSplats made;
    reserve_splats(made.set, std::int64_t(most_expected * expected));
    made.detail = add_splats(picture, surface, task, progress, made.set);
    made.faces = faces_of(made.set, surface, texture.image);
    made.light = std::move(picture.light);
    return made;
}

// The picture at `area` of its texels; one that is a line becomes a shorter line.
Image smaller(const Image& image, double area) {
    if (std::min(image.width, image.height) > 1) return at_area(image, area, 1.0);
    const auto length = std::max<std::int64_t>(1, std::int64_t(area));
    return reduced_by_area(image, std::min(length, image.width), std::min(length, image.height));
}

// A picture's splats on its mesh. While they are more than `most` (0: any number), the picture is reduced.
SplatSet bodies_of(const PictureOnMesh& picture, std::size_t number, Texture& texture, double expected,
                   std::int64_t most, BodiesTask task, const Progress& progress) {
    constexpr int most_tries = 8;
    constexpr double aimed_at = 0.97, made_share = 0.45;  // of the time, that making the splats takes
    for (int tries = 1;; ++tries) {
        const UvSurface surface = surface_of(*picture.mesh, picture.material);
        MadeSplats made = made_of(texture, surface, task, expected, most > 0, progress.part(0.0, made_share));
        const std::int64_t rows = std::accumulate(made.faces.begin(), made.faces.end(), std::int64_t{0});
        if (most > 0 && rows > most) {
            if (tries == most_tries)
                throw InputError(
                    fmt::format("source.splats: expected at least {} for a picture of {}x{} px, found {}",
                                rows, texture.image.width, texture.image.height, most));
            const double area = double(texels_of(texture)) * aimed_at * double(most) / double(rows);
            texture.image = smaller(texture.image, area);
            log_detail(fmt::format("layer '{}': {} rows are more than {}, so its picture is reduced to {}x{}",
                                   task.layer_name, rows, most, texture.image.width, texture.image.height));
            continue;
        }
        texture.image.pixels = Buffer<float>();
        release_spare_pages();  // of the bands
        const FrontFit fit = fit_front(made.set, std::move(made.light), texture.times > 1,
                                       progress.part(made_share, 1.0), made.detail);
        made.detail.clear();
        release_spare_pages();  // of the fit
        log_detail(fmt::format("layer '{}': front view {:.1f} dB after {} steps of the fit", task.layer_name,
                               fit.psnr_db, fit.steps));
        const std::int64_t positions = made.set.splats.size();
        const bool absorbs = made.set.absorbs;
        SplatSet set = on_mesh(std::move(made.set), made.faces, surface, picture, number);
        set.test_positions = positions;
        set.absorbs = absorbs;
        return set;
    }
}

// Of what the parts with detail are to show.
std::int64_t detail_memory_bytes(std::span<const TexturedMesh> meshes, const StructureParams& params) {
    constexpr double bytes_a_pixel = 13.0;  // three channels, and what is shown about each part
    double most = 0.0;
    for (const PictureOnMesh& picture : pictures_of(meshes)) {
        const Image& image = picture.texture().image;
        const DetailLevels levels(params, image.width, image.height);
        most = std::max(most, double(image.width * image.height) *
                                  (4.0 * levels.area_share(1) + 16.0 * levels.area_share(2)));
    }
    return std::int64_t(bytes_a_pixel * most);
}

}  // namespace

SplatSet make_bodies(std::vector<TexturedMesh> meshes, const StructureParams& params, std::uint32_t seed,
                     const std::string& layer_name, const Progress& progress, std::int64_t most_splats) {
    const std::vector<PictureOnMesh> pictures = pictures_of(meshes);
    std::vector<double> expected;
    for (const PictureOnMesh& picture : pictures)
        expected.push_back(expected_splats(picture.texture(), params));
    const double all = std::accumulate(expected.begin(), expected.end(), 0.0);
    claim_memory(bodies_memory_bytes(meshes, params, std::int64_t(all)) + detail_memory_bytes(meshes, params),
                 fmt::format("making bodies for layer '{}'", layer_name));
    SplatSet set;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const PictureOnMesh& picture = pictures[i];
        Texture& texture = meshes[picture.mesh_index].textures[picture.material];
        const auto share = std::int64_t(double(most_splats) * expected[i] / all);
        const auto done = [&](std::size_t n) { return double(n) / double(pictures.size()); };
        SplatSet rows = bodies_of(
            picture, i, texture, expected[i], most_splats > 0 ? std::max<std::int64_t>(1, share) : 0,
            {params, seed + std::uint32_t(i), layer_name}, progress.part(done(i), done(i + 1)));
        set.test_positions += rows.test_positions;
        set.absorbs = set.absorbs || rows.absorbs;
        append(std::move(rows), set);
        if (set.credit.empty()) set.credit = texture.credit;
    }
    sort_by_id(set);
    for (const float distance : set.distance) set.max_distance = std::max(set.max_distance, double(distance));
    set.divided = true;
    return set;
}

}  // namespace astrosplat

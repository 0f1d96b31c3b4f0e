#include "viewer/set_loader.h"

#include <tuple>

#include "core/parallel.h"
#include "core/real.h"
#include "generate/generate.h"
#include "image/blur.h"
#include "image/channels.h"
#include "source/textured_mesh.h"

namespace astrosplat {
namespace {

constexpr std::int64_t most_pixels = 200'000;  // of a picture in a preview: splats hardly lie closer
constexpr std::int64_t live_rows_at_once = 1 << 13;
constexpr std::int64_t most_moved = 40'000;  // splats of a body that follow a hand
constexpr std::int64_t most_kept_ready =
    30'000'000;  // splats of bodies whose pictures are read only to be ready

/// Every n-th pixel of every n-th row: values stay, so that levels do to them what they do to all.
template <class Copy>
void for_each_thinned(std::int64_t width, std::int64_t height, std::int64_t step, const Copy& copy) {
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) copy(x * step + step / 2, y * step + step / 2);
}

RawPicture thinned(RawPicture raw) {
    const Image& image = raw.picture.image;
    const std::int64_t full_width = raw.fits ? raw.fits->width : image.width,
                       full_height = raw.fits ? raw.fits->height : image.height;
    const double pixels = static_cast<double>(full_width) * static_cast<double>(full_height);
    const auto step = static_cast<std::int64_t>(std::ceil(std::sqrt(pixels / double(most_pixels))));
    const std::int64_t width = full_width / std::max<std::int64_t>(step, 1),
                       height = full_height / std::max<std::int64_t>(step, 1);
    if (step <= 1 || width < 1 || height < 1) return raw;
    if (raw.fits) {
        Buffer<double> values;
        const int channels = raw.fits->channels;
        values.reserve(static_cast<std::size_t>(width * height * channels));
        for_each_thinned(width, height, step, [&](std::int64_t x, std::int64_t y) {
            for (int c = 0; c < channels; ++c)
                values.push_back(
                    raw.fits->values[static_cast<std::size_t>((y * full_width + x) * channels + c)]);
        });
        raw.fits->values = std::move(values);
        raw.fits->width = width;
        raw.fits->height = height;
        return raw;
    }
    Image few = make_image(width, height, image.channels);
    float* to = few.pixels.data();
    for_each_thinned(width, height, step, [&](std::int64_t x, std::int64_t y) {
        to = std::copy_n(image.at(x, y), image.channels, to);
    });
    raw.picture.image = std::move(few);
    return raw;
}

/// Files that are read once, and thinned after that.
class ThinnedFiles {
  public:
    /// Files as they are, for shapes that are made of pictures.
    RawReader whole_reader() {
        return [this](const fs::path& file, const std::string& hdu, std::optional<int> plane,
                      const Progress& progress) {
            RawPicture raw = read_raw(file, hdu, plane, progress);
            files_.insert_or_assign({file, hdu, plane}, thinned(raw));
            return raw;
        };
    }
    RawReader reader() {
        return [this](const fs::path& file, const std::string& hdu, std::optional<int> plane,
                      const Progress& progress) {
            const auto found = files_.find({file, hdu, plane});
            return found != files_.end() ? found->second : thinned(read_raw(file, hdu, plane, progress));
        };
    }

  private:
    std::map<std::tuple<fs::path, std::string, std::optional<int>>, RawPicture> files_;
};

/// The pictures of all meshes, as smooth as the splats that show them.
std::vector<Image> blurred_pictures(const std::vector<TexturedMesh>& meshes) {
    constexpr double sigma_of_width = 0.004;  // of the blur, as a share of the picture's width
    std::vector<Image> pictures;
    for (const TexturedMesh& m : meshes)
        for (const Texture& texture : m.textures)
            pictures.push_back(texture.image.width == 0
                                   ? Image{}
                                   : gaussian_blur(texture.image, sigma_of_width * static_cast<double>(
                                                                                       texture.image.width)));
    return pictures;
}

glm::vec3 light_at(const Image& picture, glm::vec2 uv) {
    const glm::vec2 at = 1.0f - glm::abs(glm::mod(uv, 2.0f) - 1.0f);  // mirrored beyond the edges
    const LinearSample place(picture, at.x * static_cast<float>(picture.width),
                             (1.0f - at.y) * static_cast<float>(picture.height));
    return {place.of(picture, 0), place.of(picture, 1), place.of(picture, 2)};
}

float brightest(const glm::vec3& light) { return std::max({light.x, light.y, light.z}); }

/// A splat where the picture's light became another: opacity follows the brightness as it did when the splat
/// was made (DEPTH 5), and the colour makes the light of both follow the picture's.
void follow(const glm::vec3& before, const glm::vec3& now, float power, glm::vec3& color, float& alpha) {
    constexpr float least = 0.002f, most = 16.0f;  // of white; of the ratio
    const auto ratio = [&](float from, float to) {
        return std::min((std::max(to, 0.0f) + least) / (std::max(from, 0.0f) + least), most);
    };
    if (color.x < 0.0f) return;  // it absorbs
    const auto depth = static_cast<float>(real::pow(ratio(brightest(before), brightest(now)), power));
    const float old_alpha = std::min(alpha, 0.999f);
    alpha = 1.0f - static_cast<float>(real::pow(1.0f - old_alpha, depth));
    const float share = alpha > 0.0f ? old_alpha / alpha : 0.0f;
    for (int c = 0; c < 3; ++c) color[c] *= ratio(before[c], now[c]) * share;
}

std::vector<SourceParams> sources_of(const Scene& scene) {
    std::vector<SourceParams> sources;
    for (const LayerParams& layer : scene.layers) sources.push_back(layer.source);
    return sources;
}

/// The set that a preview of the layer under its present levels can be made of.
std::shared_ptr<const LoadedLayer> base_of(const SetLoader& loader, const LayerParams& layer) {
    auto loaded = loader.layer(layer.name);
    if (!loaded || !loaded->set || loaded->outdated) return nullptr;
    return can_follow(loaded->source, layer.source) ? loaded : nullptr;
}

/// The inputs of previews of one set, kept from step to step.
struct LiveSample {
    explicit LiveSample(PictureMaker maker) : prepared(std::move(maker)) {}

    PictureMaker prepared;
    std::shared_ptr<const SplatSet> set;  // of all below
    ThinnedFiles files;
    std::vector<TexturedMesh> meshes;
    MergeSource sample;
    TextureSettings texture;    // of bodies: that the set was made of
    std::vector<Image> before;  // and the pictures
    std::optional<MovedBodies> moved;

    void begin(const LoadedLayer& loaded, const Progress& progress);
    SplatSet columns(const SourceParams& source, const Progress& progress);
    SplatSet bodies(const SourceParams& source, const Progress& progress);
    LiveFound under(const LiveRequest& request, const Progress& progress);
};

void LiveSample::begin(const LoadedLayer& loaded, const Progress& progress) {
    if (set == loaded.set) return;
    set.reset();  // an exception below must not leave half of it
    files = {};
    moved.reset();
    before.clear();
    meshes = load_meshes(loaded.source, progress, {prepared, files.whole_reader()});
    if (loaded.columns.set) {
        sample = source_of(loaded.columns.set, loaded.columns.of);
    } else {
        sample = loaded.sample.weight > 1.0f && !loaded.set->radius.empty()
                     ? light_sample(*loaded.set, most_moved)
                     : loaded.sample;
        moved.emplace(moved_bodies(loaded.source, std::move(meshes), loaded.name, *sample.set));
        meshes = load_meshes(loaded.source, progress, {prepared, files.reader()});
        before = blurred_pictures(meshes);
        texture = loaded.source.texture;
    }
    set = loaded.set;
}

SplatSet LiveSample::columns(const SourceParams& source, const Progress& progress) {
    reload_pictures(source, meshes, progress, {prepared, files.reader()});
    Columns columns{*sample.set};
    read_texels(meshes, columns, progress);
    return std::move(columns.splats);
}

SplatSet LiveSample::bodies(const SourceParams& source, const Progress& progress) {
    SplatSet rows = moved->under(source.structure);
    if (source.texture == texture) return rows;
    reload_pictures(source, meshes, progress, {prepared, files.reader()});
    const std::vector<Image> now = blurred_pictures(meshes);
    std::vector<std::size_t> first;  // picture of each mesh
    std::size_t pictures = 0;
    for (const TexturedMesh& m : meshes)
        first.push_back(std::exchange(pictures, pictures + m.textures.size()));
    const auto power = static_cast<float>(source.structure.opacity);
    parallel_each(rows.id.size(), live_rows_at_once, [&](std::size_t i) {
        const std::size_t picture = first[rows.mesh[i]];
        if (now[picture].width == 0) return;
        follow(light_at(before[picture], rows.uv[i]), light_at(now[picture], rows.uv[i]), power,
               rows.color[i], rows.alpha[i]);
    });
    return rows;
}

LiveFound LiveSample::under(const LiveRequest& request, const Progress& progress) {
    begin(*request.loaded, progress);
    auto layer = std::make_shared<LoadedLayer>(*request.loaded);
    layer->set.reset();
    layer->whole = {};
    layer->sample = sample;
    layer->sample.set = std::make_shared<const SplatSet>(moved ? bodies(request.source, progress)
                                                               : columns(request.source, progress));
    layer->source = request.source;
    return {std::move(layer), {}};
}

}  // namespace

bool can_follow(const SourceParams& before, const SourceParams& now) {
    if (now.kind != SourceKind::mesh || before == now) return false;
    SourceParams same = before;
    if (!prepares(now.texture.prepare)) {
        same.texture = now.texture;
        same.texture.hdu = before.texture.hdu;
        same.texture.plane = before.texture.plane;
        same.texture.prepare = before.texture.prepare;
    }
    if (only_moves_bodies(before.structure, now.structure)) same.structure = now.structure;
    return same == now;
}

bool LiveRequest::operator==(const LiveRequest& other) const {
    const auto set_of = [](const LiveRequest& r) { return r.loaded ? r.loaded->set : nullptr; };
    return set_of(*this) == set_of(other) && source == other.source;
}

LatestWork<LiveRequest, LiveFound>::Work live_maker(const PictureMaker& prepared) {
    return [sample = std::make_shared<LiveSample>(prepared)](const LiveRequest& request,
                                                             const Progress& progress) {
        return sample->under(request, progress);
    };
}

void LiveSets::want(const LiveRequest& request) {
    if (const auto found = work_.found(asked_)) {
        base_ = asked_.loaded->set;
        found_ = found->layer;
    }
    if (work_.working() && asked_.loaded->set == request.loaded->set) return;
    asked_ = request;
    work_.want(request);
}

std::shared_ptr<const LoadedLayer> LiveSets::layer(const std::shared_ptr<const LoadedLayer>& loaded) const {
    return base_ == loaded->set ? found_ : nullptr;
}

void LiveSets::forget() {
    work_.cancel();
    base_.reset();
    found_.reset();
}

bool SetWishes::due(const Document& document, double now) {
    constexpr double rest_s = 0.4;
    if (document.revision() == wanted_revision_) return false;
    const std::vector<SourceParams> sources = sources_of(document.scene());
    const bool same_layers = sources.size() == wanted_sources_.size();
    const bool edited = same_layers && sources != wanted_sources_;
    const bool moves = edited && sources != edited_sources_ && abandon_followed(document.scene());
    if (edited && (source_edited_at_ < 0.0 || moves)) source_edited_at_ = now;
    edited_sources_ = sources;
    return source_edited_at_ < 0.0 || now - source_edited_at_ >= rest_s;
}

void SetWishes::want(const Document& document) {
    loader_.want(document.scene());
    wanted_revision_ = document.revision();
    wanted_sources_ = sources_of(document.scene());
    source_edited_at_ = -1.0;
}

bool SetWishes::loaded(const Document& document) const {
    return loader_.idle() && wanted_revision_ == document.revision();
}

bool SetWishes::wanted(const Scene& scene) const { return wanted_sources_ == sources_of(scene); }

/// Sets of levels that were passed on the way would hold up the preview. False: none is followed.
bool SetWishes::abandon_followed(const Scene& scene) {
    bool any = false;
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        const auto base = base_of(loader_, scene.layers[i]);
        if (!base) continue;
        loader_.abandon(scene.layers[i].name);
        wanted_sources_[i] = base->source;
        any = true;
    }
    return any;
}

void SetWishes::follow(const Scene& scene, std::size_t layer, bool spare) {
    follows_ = true;
    for (const LayerParams& edited : scene.layers)
        if (const auto base = base_of(loader_, edited)) return live_.want({base, edited.source});
    follows_ = false;
    const auto loaded = layer < scene.layers.size() ? loader_.layer(scene.layers[layer].name) : nullptr;
    const bool moves = loaded && loaded->set && !loaded->outdated && loaded->splats <= most_kept_ready &&
                       loaded->source.kind == SourceKind::mesh && !loaded->columns.set;
    if (moves && (spare || live_.knows(*loaded))) return live_.want({loaded, loaded->source});
    live_.forget();
}

std::shared_ptr<const LoadedLayer> SetWishes::layer(const LayerParams& layer) const {
    if (const auto base = base_of(loader_, layer))
        if (auto live = live_.layer(base)) return live;
    return loader_.layer(layer.name);
}

}  // namespace astrosplat

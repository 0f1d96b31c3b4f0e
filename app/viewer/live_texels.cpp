#include "viewer/live_texels.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/real.h"
#include "generate/generate.h"
#include "image/blur.h"
#include "image/channels.h"
#include "source/textured_mesh.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t most_pixels = 200'000;  // of a picture in a preview: splats hardly lie closer
constexpr std::int64_t live_rows_at_once = 1 << 13;

/// Every n-th pixel of every n-th row: values stay as they are, so that levels do to them what they do to
/// all.
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
        values.reserve(static_cast<std::size_t>(width * height));
        for_each_thinned(width, height, step, [&](std::int64_t x, std::int64_t y) {
            values.push_back(raw.fits->values[static_cast<std::size_t>(y * full_width + x)]);
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
        return [this](const fs::path& file, const std::string& hdu, int plane, const Progress& progress) {
            RawPicture raw = read_raw(file, hdu, plane, progress);
            files_.insert_or_assign({file, hdu, plane}, thinned(raw));
            return raw;
        };
    }
    RawReader reader() {
        return [this](const fs::path& file, const std::string& hdu, int plane, const Progress& progress) {
            const auto found = files_.find({file, hdu, plane});
            return found != files_.end() ? found->second : thinned(read_raw(file, hdu, plane, progress));
        };
    }

  private:
    std::map<std::tuple<fs::path, std::string, int>, RawPicture> files_;
};

/// The pictures of all meshes, as smooth as the dots that show them.
std::vector<Image> blurred_pictures(const std::vector<TexturedMesh>& meshes) {
    constexpr double sigma_of_width = 0.004;
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

/// One dot where the picture's light became another: opacity follows the brightness as it did when the dot
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

}  // namespace

bool only_texels_differ(const SourceParams& before, const SourceParams& now) {
    if (now.kind != SourceKind::mesh || prepares(now.texture.prepare) || before == now) return false;
    SourceParams same = before;
    same.texture = now.texture;
    same.texture.hdu = before.texture.hdu;
    same.texture.plane = before.texture.plane;
    same.texture.prepare = before.texture.prepare;
    return same == now;
}

bool LiveRequest::operator==(const LiveRequest& other) const {
    const auto set_of = [](const LiveRequest& r) { return r.loaded ? r.loaded->set : nullptr; };
    return set_of(*this) == set_of(other) && source == other.source;
}

struct LiveMaker::State {
    std::shared_ptr<const SplatSet> set;  // of all below
    ThinnedFiles files;
    std::vector<TexturedMesh> meshes;
    MergeSource sample;
    std::vector<Image> before;  // of structures: the pictures that the set was made of

    void begin(const LoadedLayer& loaded, const Progress& progress);
    SplatSet columns(const Progress& progress) const;
    SplatSet structure(const SourceParams& source) const;
};

void LiveMaker::State::begin(const LoadedLayer& loaded, const Progress& progress) {
    if (set == loaded.set) return;
    set.reset();  // an exception below must not leave half of it
    files = {};
    meshes = load_meshes(loaded.source, progress, {make_prepared, files.whole_reader()});
    before.clear();
    if (loaded.columns.set) {
        sample = source_of(loaded.columns.set, loaded.columns.of);
    } else {
        sample = loaded.sample;
        reload_pictures(loaded.source, meshes, progress, {make_prepared, files.reader()});
        before = blurred_pictures(meshes);
    }
    set = loaded.set;
}

SplatSet LiveMaker::State::columns(const Progress& progress) const {
    Columns columns{*sample.set};
    read_texels(meshes, columns, progress);
    return std::move(columns.splats);
}

SplatSet LiveMaker::State::structure(const SourceParams& source) const {
    const std::vector<Image> now = blurred_pictures(meshes);
    std::vector<std::size_t> first;  // picture of each mesh
    std::size_t pictures = 0;
    for (const TexturedMesh& m : meshes)
        first.push_back(std::exchange(pictures, pictures + m.textures.size()));
    SplatSet dots = *sample.set;
    const auto power = static_cast<float>(source.structure.opacity);
    parallel_each(dots.id.size(), live_rows_at_once, [&](std::size_t i) {
        const std::size_t picture = first[dots.mesh[i]];
        if (now[picture].width == 0) return;
        follow(light_at(before[picture], dots.uv[i]), light_at(now[picture], dots.uv[i]), power,
               dots.color[i], dots.alpha[i]);
    });
    return dots;
}

LiveMaker::LiveMaker() : state_(std::make_shared<State>()) {}
LiveMaker::~LiveMaker() = default;

LiveFound LiveMaker::operator()(const LiveRequest& request, const Progress& progress) {
    State& state = *state_;
    state.begin(*request.loaded, progress);
    reload_pictures(request.source, state.meshes, progress, {make_prepared, state.files.reader()});
    const bool columns = request.loaded->columns.set != nullptr;
    auto layer = std::make_shared<LoadedLayer>(*request.loaded);
    layer->set.reset();
    layer->whole = {};
    layer->sample = state.sample;
    layer->sample.set =
        std::make_shared<const SplatSet>(columns ? state.columns(progress) : state.structure(request.source));
    layer->source = request.source;
    return {std::move(layer), {}};
}

void LiveTexels::want(const LiveRequest& request) {
    if (const auto found = work_.found(asked_)) {
        base_ = asked_.loaded->set;
        found_ = found->layer;
    }
    if (work_.working() && asked_.loaded->set == request.loaded->set) return;
    asked_ = request;
    work_.want(request);
}

std::shared_ptr<const LoadedLayer> LiveTexels::layer(const std::shared_ptr<const LoadedLayer>& loaded) const {
    return base_ == loaded->set ? found_ : nullptr;
}

void LiveTexels::forget() {
    work_.cancel();
    base_.reset();
    found_.reset();
}

}  // namespace astrosplat

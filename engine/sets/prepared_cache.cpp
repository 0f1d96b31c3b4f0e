#include "sets/prepared_cache.h"

#include <fmt/format.h>

#include <utility>

#include "core/error.h"
#include "core/log.h"
#include "core/sha256.h"
#include "sets/recipe.h"
#include "source/picture.h"
#include "source/prepared_picture.h"
#include "source/stored_picture.h"
#include "source/write_image.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

PreparedPicture kept_or_prepared(const SetCache& cache, const std::vector<fs::path>& files,
                                 const TextureSettings& settings, const Progress& progress) {
    const std::string text = cache.folder.empty() ? "" : prepared_recipe_text(files, settings, progress);
    if (text.empty()) return prepare_picture(files, settings, progress);
    const fs::path file = cache.folder / (Sha256().add(text).hex() + ".exr");
    if (std::optional<PreparedPicture> kept =
            read_kept_picture(file, "the picture is prepared again", progress))
        return std::move(*kept);
    PreparedPicture picture = prepare_picture(files, settings, progress);
    if (prepared_recipe_text(files, settings, progress) == text)
        keep_picture(cache, file, without_plain_alpha(picture.image), picture.credit);
    return picture;
}

}  // namespace

std::optional<PreparedPicture> read_kept_picture(const fs::path& file, const char* remedy,
                                                 const Progress& progress) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return {};
    try {
        Stored stored = read_stored(file, {}, progress);
        PreparedPicture picture;
        picture.credit = stored.picture.credit;
        picture.image = linear_image(std::move(stored), TextureSettings::Colorspace::linear);
        fs::last_write_time(file, fs::file_time_type::clock::now(), error);  // refused: it seems older
        return picture;
    } catch (const InputError& damage) {
        log_warning(fmt::format("{}; {}", damage.what(), remedy));
        fs::remove(file, error);
    }
    return {};
}

void keep_picture(const SetCache& cache, const fs::path& file, const Image& image,
                  const std::string& credit) {
    const auto bytes = static_cast<std::int64_t>(image.pixels.size() * sizeof(float));
    if (bytes > limit_bytes(cache)) return;
    shrink_cache(cache, limit_bytes(cache) - bytes);
    std::error_code error;
    fs::create_directories(cache.folder, error);
    try {
        write_linear_image(file, image, credit, Existing::replace);
    } catch (const OutputError& failure) {
        warn_unkept(cache, failure.what());
    }
}

PictureMaker kept_pictures(const SetCache& cache) {
    return [cache](const std::vector<fs::path>& files, const TextureSettings& settings,
                   const Progress& progress) { return kept_or_prepared(cache, files, settings, progress); };
}

std::vector<TexturedMesh> load_meshes(const SetCache& cache, const SourceParams& source,
                                      const Progress& progress, std::int64_t most_texels) {
    return load_meshes(source, progress, {kept_pictures(cache), {}, most_texels});
}

}  // namespace astrosplat

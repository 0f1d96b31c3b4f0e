#include "sets/kept.h"

#include <fmt/format.h>

#include <cstdlib>
#include <tuple>

#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/memory.h"
#include "source/picture.h"
#include "source/stored_picture.h"
#include "source/write_image.h"

namespace astrosplat {
namespace {

constexpr std::int64_t largest_limit = std::int64_t{20} << 30;  // bytes

}  // namespace

fs::path default_cache_folder() {
    const char* folder = std::getenv("ASTROSPLAT_CACHE");
    return folder && *folder ? fs::path(folder) : cache_folder();
}

std::int64_t limit_bytes(const SetCache& cache) {
    if (cache.limit_bytes > 0) return cache.limit_bytes;
    std::error_code error;
    const fs::space_info disk = fs::space(cache.folder, error);
    if (error) return largest_limit;
    return std::int64_t(std::min<std::uintmax_t>(disk.capacity / 10, largest_limit));
}

void shrink_cache(const SetCache& cache, std::int64_t bytes) {
    struct Entry {
        fs::file_time_type used;
        fs::path file;
        std::int64_t bytes;
    };
    std::vector<Entry> entries;
    std::int64_t total = 0;
    std::error_code error;
    for (const fs::path& file : entries_of(cache.folder)) {
        constexpr std::array endings = {".splats", ".texels", ".tree", ".exr"};
        const std::string ending = file.extension().string();
        const bool entry = std::ranges::any_of(endings, [&](const char* own) { return ending == own; });
        if (!entry || file.filename().string().front() == '.') continue;
        entries.push_back({fs::last_write_time(file, error), file, 0});
        const std::uintmax_t size = fs::file_size(file, error);
        if (!error) entries.back().bytes = std::int64_t(size);  // else another process removed it
        total += entries.back().bytes;
    }
    std::ranges::sort(entries, {}, [](const Entry& entry) { return std::tie(entry.used, entry.file); });
    for (const Entry& entry : entries) {
        if (total <= bytes) return;
        if (fs::remove(entry.file, error)) log_detail(entry.file.string() + ": removed from the cache");
        total -= entry.bytes;
    }
}

void warn_unkept(const SetCache& cache, const std::string& why) {
    log_warning(fmt::format("cache {}: {}; what was generated is not kept", cache.folder.string(), why));
}

namespace {

/// The result of read() for an entry. Nothing where there is none, or none that can be used: one that is
/// damaged, or that was made of something else, whatever its name says, for which read() throws; it is
/// removed with a warning that ends in `remedy`. Where the memory left would not hold it the generator is to
/// say so.
template <class Read>
auto read_entry(const fs::path& file, const char* remedy, const Read& read)
    -> std::optional<decltype(read(file))> {
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(file, error);
    if (error || bytes > static_cast<std::uintmax_t>(available_memory_bytes())) return std::nullopt;
    try {
        auto result = read(file);
        fs::last_write_time(file, fs::file_time_type::clock::now(), error);  // refused: it seems older
        return result;
    } catch (const InputError& damage) {
        log_warning(fmt::format("{}; {}", damage.what(), remedy));
        fs::remove(file, error);
    }
    return std::nullopt;
}

constexpr const char* generated_again = "the set is generated again";

/// Calls write() for an entry of so many bytes where the cache has room, which is made; what cannot be
/// written costs a warning. False: the cache may not hold so much.
template <class Write>
bool write_entry(const SetCache& cache, std::int64_t bytes, const Write& write) {
    const std::int64_t limit = limit_bytes(cache);
    if (bytes > limit) return false;
    shrink_cache(cache, limit - bytes);
    try {
        write();
    } catch (const OutputError& error) {
        warn_unkept(cache, error.what());
    }
    return true;
}

void require_own(const fs::path& file, bool is_own) {
    if (!is_own) bad_input(file, "recipe", "that of the set asked for", "another");
}

bool is_geometry(const std::string& text, const std::string& name) {
    return Sha256().add(text).hex() == name;
}

/// The parts of kept columns that are to be read: the lit ones, and a sample of all.
struct ColumnChoice {
    LitRows lit;
    Buffer<std::int64_t> sample;
    OptionalColumns wanted;

    std::array<NativeRows, 2> rows() const {
        return {NativeRows{lit.rows, wanted}, NativeRows{sample, {true, true, true, true}}};
    }
};

void add_colors(SplatSet colors, SplatSet& set) {
    set.color = std::move(colors.color);
    set.alpha = std::move(colors.alpha);
    set.divided = colors.divided;
    set.credit = std::move(colors.credit);
    set.origin = std::move(colors.origin);
    set.recipe.clear();
}

}  // namespace

fs::path set_file(const SetCache& cache, const std::string& name) {
    return cache.folder / (name + ".splats");
}

fs::path texel_file(const SetCache& cache, const std::string& name) {
    return cache.folder / (name + ".texels");
}

std::string texel_recipe(const Recipe& recipe, const std::string& geometry_name) {
    return recipe.text + "geometry " + geometry_name;
}

std::optional<SplatSet> read_whole(const SetCache& cache, const Recipe& recipe, const Progress& progress,
                                   const OptionalColumns& wanted) {
    return read_entry(set_file(cache, recipe.name), generated_again, [&](const fs::path& file) {
        SplatSet set = read_native(file, progress, wanted);
        require_own(file, std::exchange(set.recipe, "") == recipe.text);
        return set;
    });
}

std::optional<Columns> read_geometry(const SetCache& cache, const std::string& name,
                                     const Progress& progress) {
    return read_entry(set_file(cache, name), generated_again, [&](const fs::path& file) {
        SplatSet set = read_native(file, progress, {true, true, true, true}, NativePart::geometry);
        require_own(file, is_geometry(std::exchange(set.recipe, ""), name));
        return Columns{std::move(set)};
    });
}

/// Dark positions are passed by: to read them into memory first takes as long as all else.
std::optional<KeptColumns> read_columns(const SetCache& cache, const Recipe& recipe,
                                        std::int64_t sample_limit, const OptionalColumns& wanted,
                                        const Progress& progress) {
    ColumnChoice choice;
    choice.wanted = wanted;
    const std::string beginning = texel_recipe(recipe, "");
    auto colors = read_entry(texel_file(cache, recipe.name), generated_again, [&](const fs::path& file) {
        choice.lit = native_lit_rows(file, progress);
        choice.sample = sampled_rows(choice.lit.of, sample_limit);
        auto sets = read_native_rows(file, NativePart::colors, choice.rows(), progress);
        require_own(file, sets[0].recipe.starts_with(beginning));
        return sets;
    });
    if (!colors) return std::nullopt;
    const std::string name = colors->front().recipe.substr(beginning.size());
    auto sets = read_entry(set_file(cache, name), generated_again, [&](const fs::path& file) {
        auto found = read_native_rows(file, NativePart::geometry, choice.rows(), progress);
        require_own(file, is_geometry(found[0].recipe, name) && native_splat_count(file) == choice.lit.of);
        return found;
    });
    if (!sets) return std::nullopt;
    for (std::size_t i = 0; i < sets->size(); ++i) add_colors(std::move((*colors)[i]), (*sets)[i]);
    KeptColumns kept{std::move((*sets)[0]), {std::move((*sets)[1])}, choice.lit.of};
    kept.set.zero_alpha += kept.positions - kept.set.size();
    return kept;
}

void keep(const SetCache& cache, const std::vector<KeptFile>& entries, SplatSet& set,
          const Progress& progress) {
    std::int64_t bytes = 0;
    for (const KeptFile& entry : entries) {
        set.recipe = entry.recipe;
        bytes += native_file_bytes(set, entry.part);
    }
    const bool has_room = write_entry(cache, bytes, [&] {
        for (const KeptFile& entry : entries) {
            set.recipe = entry.recipe;
            write_native(entry.file, set, progress.silent(), RowOrder::id, entry.part);
        }
    });
    if (!has_room)
        log_info(fmt::format("a set of {} is not kept: the cache may hold {}", human_bytes(double(bytes)),
                             human_bytes(double(limit_bytes(cache)))));
    set.recipe.clear();
}

namespace {

std::optional<PreparedPicture> read_kept_picture(const fs::path& file, const char* remedy,
                                                 const Progress& progress) {
    return read_entry(file, remedy, [&](const fs::path&) {
        Stored stored = read_stored(file, {}, progress);
        PreparedPicture picture;
        picture.credit = stored.picture.credit;
        picture.image = linear_image(std::move(stored), TextureSettings::Colorspace::linear);
        return picture;
    });
}

void keep_picture(const SetCache& cache, const fs::path& file, const Image& image,
                  const std::string& credit) {
    const auto bytes = std::int64_t(image.pixels.size() * sizeof(float));
    write_entry(cache, bytes, [&] {
        std::error_code ignored;
        fs::create_directories(cache.folder, ignored);
        write_linear_image(file, image, credit, Existing::replace);
    });
}

fs::path file_of(const SetCache& cache, const std::string& recipe) {
    return cache.folder / (Sha256().add(recipe).hex() + ".exr");
}

// The result of a recipe: read where it is kept under the recipe's name, else made, and kept unless an input
// has changed meanwhile. An empty recipe: the result is not kept.
template <class Recipe, class Read, class Make, class Keep>
auto kept_or_made(const SetCache& cache, const Recipe& recipe_now, const Read& read, const Make& make,
                  const Keep& keep) {
    const std::string recipe = cache.folder.empty() ? "" : recipe_now();
    if (recipe.empty()) return make();
    const fs::path file = file_of(cache, recipe);
    if (auto kept = read(file)) return std::move(*kept);
    auto made = make();
    if (recipe_now() == recipe) keep(file, made);
    return made;
}

using Faces = std::array<Image, 6>;

Image strip_of(const Faces& faces) {
    Image strip = make_image(faces[0].width, 6 * faces[0].height, 3);
    auto end = strip.pixels.begin();
    for (const Image& face : faces) end = std::copy(face.pixels.begin(), face.pixels.end(), end);
    return strip;
}

// Nothing where the strip has another size.
std::optional<Faces> faces_of(const Image& strip, std::int64_t side) {
    if (strip.width != side || strip.height != 6 * side) return {};
    Faces faces;
    for (std::int64_t f = 0; f < 6; ++f) {
        Image& face = faces[f] = make_image(side, side, 3);
        for (std::int64_t y = 0; y < side; ++y)
            for (std::int64_t x = 0; x < side; ++x) std::copy_n(strip.at(x, f * side + y), 3, face.at(x, y));
    }
    return faces;
}

}  // namespace

PictureMaker kept_pictures(const SetCache& cache) {
    return [cache](const std::vector<fs::path>& files, const TextureSettings& settings,
                   const Progress& progress) {
        return kept_or_made(
            cache, [&] { return prepared_recipe_text(files, settings, progress); },
            [&](const fs::path& file) {
                return read_kept_picture(file, "the picture is prepared again", progress);
            },
            [&] { return prepare_picture(files, settings, progress); },
            [&](const fs::path& file, const PreparedPicture& made) {
                keep_picture(cache, file, without_plain_alpha(made.image), made.credit);
            });
    };
}

std::vector<TexturedMesh> load_meshes(const SetCache& cache, const SourceParams& source,
                                      const Progress& progress, std::int64_t most_texels) {
    return load_meshes(source, progress, {kept_pictures(cache), {}, most_texels});
}

SkyMaker kept_skies(const SetCache& cache) {
    return [cache](const fs::path& tile, const SkyTiling& tiling, const Progress& progress) {
        return kept_or_made(
            cache, [&] { return sky_recipe_text(tile, tiling, progress); },
            [&](const fs::path& file) -> std::optional<Faces> {
                const auto kept = read_kept_picture(file, "the sky is made again", progress);
                return kept ? faces_of(kept->image, tiling.face_px) : std::nullopt;
            },
            [&] { return tiled_sky_of(tile, tiling, progress); },
            [&](const fs::path& file, const Faces& made) { keep_picture(cache, file, strip_of(made), ""); });
    };
}

bool is_kept(const SetCache& cache, const fs::path& tile, const SkyTiling& tiling, const Progress& progress) {
    const std::string recipe = cache.folder.empty() ? "" : sky_recipe_text(tile, tiling, progress);
    std::error_code ignored;
    return !recipe.empty() && fs::is_regular_file(file_of(cache, recipe), ignored);
}

}  // namespace astrosplat

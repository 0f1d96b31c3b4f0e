// Seeds and checks of the fuzzed readers of files.
#include "fuzz/targets.h"

#include <fitsio.h>

#include <cstring>

#include "core/hash.h"
#include "fuzz/seeds.h"
#include "source/mesh.h"
#include "source/texture.h"
#include "splat_files/formats.h"
#include "splat_files/native.h"
#include "support/bits.h"

namespace astrosplat::fuzz {

namespace {

bool finite(float v) { return std::isfinite(v); }
bool finite(const glm::vec2& v) { return finite(v.x) && finite(v.y); }
bool finite(const glm::vec3& v) { return finite(v.x) && finite(v.y) && finite(v.z); }
template <class T>
void demand_array(const Buffer<T>& array, std::size_t size, bool optional) {
    demand(array.size() == size || (optional && array.empty()), "arrays of one length");
    if constexpr (!std::is_integral_v<T>)
        demand(std::all_of(array.begin(), array.end(), [](const T& v) { return finite(v); }),
               "finite numbers");
}

std::size_t check(const SplatSet& set) {
    const std::size_t size = set.position.size();
    demand_array(set.position, size, false);
    demand_array(set.color, size, false);
    demand_array(set.alpha, size, false);
    demand_array(set.distance, size, false);
    demand_array(set.id, size, false);
    demand_array(set.uv, size, true);
    demand_array(set.normal, size, true);
    demand_array(set.mesh, size, true);
    demand_array(set.radius, size, true);
    return size;
}

std::size_t read_pda_bytes(std::string_view bytes) {
    return check(read_pda(TemporaryFile(bytes, ".pda").path));
}
std::size_t read_ply_bytes(std::string_view bytes) {
    return check(read_ply(TemporaryFile(bytes, ".ply").path));
}

/// Makes the checksums of a native file of one block right again, so that mutations get past them.
std::string with_checksums(std::string bytes) {
    constexpr std::size_t word = 8, table = 32, fixed_header = 80;
    const auto put = [&](std::size_t begin, std::size_t end, std::size_t at) {
        if (begin > end || end > bytes.size() || at + word > bytes.size()) return;
        const std::uint64_t sum = xxh64(std::string_view(bytes).substr(begin, end - begin));
        std::memcpy(bytes.data() + at, &sum, word);
    };
    if (bytes.size() < fixed_header + word + table + word) return bytes;
    std::uint32_t credit = 0;
    std::memcpy(&credit, bytes.data() + 28, sizeof credit);
    const std::size_t data = (fixed_header + std::size_t{credit} + word + 63) / 64 * 64;
    const std::size_t entry = bytes.size() - word - table;
    put(0, data - word, data - word);
    put(data, entry, entry + 24);
    put(entry, entry + table, entry + table);
    return bytes;
}

std::size_t read_native_bytes(std::string_view bytes) {
    return check(read_native(TemporaryFile(with_checksums(std::string(bytes)), ".splats").path));
}

std::size_t read_obj_bytes(std::string_view bytes) {
    const Mesh mesh = load_obj(TemporaryFile(bytes, ".obj").path);
    demand(!mesh.triangles.empty(), "at least one triangle");
    for (const glm::vec3& p : mesh.positions) demand(finite(p), "finite coordinates");
    for (const Mesh::Triangle& triangle : mesh.triangles) {
        for (const std::uint32_t index : triangle.position)
            demand(index < mesh.positions.size(), "position in range");
        for (const std::uint32_t index : triangle.uv)
            demand(index == Mesh::no_uv || index < mesh.uvs.size(), "uv in range");
        demand(mesh.maps.empty() || triangle.material < mesh.maps.size(), "material in range");
    }
    return mesh.triangles.size();
}

std::size_t read_picture_bytes(std::string_view bytes, const std::string& ending) {
    const Texture texture =
        load_texture({TemporaryFile(bytes, ending).path}, TextureSettings{}, TextureSettings::Wrap::clamp);
    const Image& image = texture.image;
    demand(image.width > 0 && image.height > 0 && image.channels == 4, "an RGBA picture");
    demand(image.pixels.size() == std::size_t(image.width * image.height * 4), "all its pixels");
    for (const float value : image.pixels) demand(finite(value), "finite pixels");
    return image.pixels.size();
}

std::size_t read_fits_bytes(std::string_view bytes) { return read_picture_bytes(bytes, ".fits"); }
std::size_t read_xisf_bytes(std::string_view bytes) { return read_picture_bytes(bytes, ".xisf"); }

// ---- seeds

SplatSet small_set() {
    SplatSet set;
    for (std::uint64_t i = 0; i < 5; ++i) {
        const float f = float(i);
        set.position.push_back({f, -0.5f * f, 0.1f});
        set.color.push_back({0.25f * f, 1.0f, 1e-5f});
        set.alpha.push_back(0.2f * f);
        set.distance.push_back(0.01f * f);
        set.id.push_back(i << 33);
        set.mesh.push_back(std::uint32_t(i));
        set.radius.push_back(0.5f);
        set.uv.push_back({0.5f, 0.25f * f});
    }
    set.credit = "somebody";
    return set;
}

/// 2 x 2 grey pixels, plain and stored in the header, and compressed by zlib.
std::vector<std::string> xisf_seeds() {
    const auto file = [](const std::string& attributes, const std::string& text) {
        const std::string header =
            "<?xml version=\"1.0\"?><xisf version=\"1.0\"><Image geometry=\"2:2:1\" "
            "sampleFormat=\"UInt8\" colorSpace=\"Gray\" location=\"inline:hex\" " +
            attributes + ">" + text + "</Image></xisf>";
        return std::string("XISF0100") + char(header.size() & 255U) + char(header.size() >> 8U) +
               std::string(6, '\0') + header;
    };
    return {file("", "01020304"), file("compression=\"zlib:4\"", "789c6364626601000018000b"),
            file("subblocks=\"3,2:3,2\" compression=\"lz4:4\"", "200102200304"),
            file("checksum=\"sha-1:12dada1fff4d4787ade3333147202c3b443e376f\"", "01020304")};
}

std::string written(void (*write)(const WriteTarget&, const SplatSet&, const Progress&),
                    const std::string& ending) {
    const TemporaryFile file("", "." + ending);
    write(file.path, small_set(), {});
    return test::bytes_of(file.path);
}

const char* const ascii_ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty float y\nproperty float z\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty list uchar int links\nelement "
    "face 1\n"
    "property list uchar int vertex_indices\nend_header\n0 0 1 255 0 7 0\n1 0 1e-3 0 9 7 2 1 2\n0 1 1 5 6 7 "
    "0\n"
    "3 0 1 2\n";

std::string big_endian_ply() {
    std::string bytes =
        "ply\nformat binary_big_endian 1.0\nelement face 1\nproperty list uchar short i\nelement vertex 2\n"
        "property float x\nproperty float y\nproperty float z\nproperty list uchar uchar more\nend_header\n";
    bytes += std::string("\x02\x00\x01\x00\x02", 5);
    for (int row = 0; row < 2; ++row) bytes += std::string("\x3f\x80\0\0\0\0\0\0\xbf\x80\0\0\x01\x07", 14);
    return bytes;
}

const char* const obj =
    "# box\nmtllib absent.mtl\no one\nv 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "vn 0 0 1\nusemtl red\nf 1/1/1 2/2/1 3/3/1 4/4/1\ng two\nf -4//1 -3//1 -2//1\nf 1 3 4\n";

/// A tile-compressed FITS file of 8 x 6 numbers.
std::string compressed_fits(int compression) {
    const TemporaryFile file("", ".fits");
    fs::remove(file.path);
    fitsfile* out = nullptr;
    int status = 0;
    long axes[] = {8, 6};
    short values[8 * 6];
    for (int i = 0; i < 8 * 6; ++i) values[i] = short(i * 7 % 31);
    fits_create_diskfile(&out, file.path.c_str(), &status);
    fits_set_compression_type(out, compression, &status);
    fits_create_img(out, SHORT_IMG, 2, axes, &status);
    fits_write_img(out, TSHORT, 1, 8 * 6, values, &status);
    fits_close_file(out, &status);
    demand(status == 0, "a compressed FITS file");
    return test::bytes_of(file.path);
}

std::vector<std::string> fits_seeds() {
    return {bzipped(compressed_fits(RICE_1)),
            compressed_fits(RICE_1),
            compressed_fits(HCOMPRESS_1),
            compressed_fits(GZIP_1),
            compressed_fits(GZIP_2),
            fits({"SIMPLE  =                    T", "BITPIX  =                   16",
                  "NAXIS   =                    2", "NAXIS1  =                    4",
                  "NAXIS2  =                    3", "BZERO   =                 10.0",
                  "BSCALE  =                  0.5", "BLANK   =                    7", "ORIGIN  = 'hand    '",
                  "END"})};
}

}  // namespace

const std::vector<Target>& targets() {
    using Seeds = std::vector<std::string>;
    static const std::vector<Target> all = {
        {"pda", [] { return Seeds{written(write_pda, "pda")}; }, read_pda_bytes},
        {"ply",
         [] {
             return Seeds{written(write_ply, "ply"), ascii_ply, big_endian_ply()};
         },
         read_ply_bytes},
        {"splats",
         [] {
             return Seeds{written([](const auto& file, const auto& set,
                                     const auto& progress) { write_native(file, set, progress); },
                                  "splats")};
         },
         read_native_bytes},
        {"obj", [] { return Seeds{obj}; }, read_obj_bytes},
        {"fits", fits_seeds, read_fits_bytes},
        {"xisf", xisf_seeds, read_xisf_bytes},
        {"stars", catalogue_seeds, read_catalogue_bytes},
        {"cameras", camera_seeds, read_camera_bytes},
        {"gaussian_ply", gaussian_ply_seeds, read_gaussian_ply_bytes},
        {"spz", spz_seeds, read_spz_bytes},
        {"compressed_ply", compressed_ply_seeds, read_gaussian_ply_bytes},
        {"splat", dot_splat_seeds, read_dot_splat_bytes},
        {"sog", sog_seeds, read_sog_bytes},
        {"gltf", gltf_seeds, read_gltf_bytes},
        {"usda", usda_seeds, read_usda_bytes},
        {"xmp", xmp_seeds, read_xmp_bytes, false},
        {"fits_metadata", fits_metadata_seeds, read_fits_metadata_bytes},
    };
    return all;
}

}  // namespace astrosplat::fuzz

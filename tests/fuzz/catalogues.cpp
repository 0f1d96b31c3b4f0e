#include "fuzz/catalogues.h"

#include <unistd.h>
#include <zlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "fuzz/targets.h"
#include "stars/catalogue.h"
#include "stars/star_set.h"
#include "unit/stars/catalogues.h"

namespace astrosplat::fuzz {
namespace {

// As one member of a gzip file; zlib's header would hold the time if it were asked to.
std::string gzipped(const std::string& text) {
    std::string packed(compressBound(static_cast<uLong>(text.size())) + 32, '\0');
    z_stream stream{};
    demand(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) == Z_OK, "a compressor");
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    demand(deflate(&stream, Z_FINISH) == Z_STREAM_END, "a gzip file");
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

bool all_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// A file of this process that holds the bytes while the object lives.
struct CatalogueFile {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("astrosplat_fuzz_" + std::to_string(::getpid()) + ".stars");
    explicit CatalogueFile(std::string_view bytes) {
        std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
    ~CatalogueFile() { std::filesystem::remove(path); }
};

std::size_t read_picture_bytes(const std::filesystem::path& file) {
    const PictureTable table = read_picture_table(file);
    demand(table.rows == table.bad.count + static_cast<std::int64_t>(table.stars.size()),
           "every row on one side");
    for (const TableStar& star : table.stars) {
        demand(std::isfinite(star.uv.x) && std::isfinite(star.uv.y) && std::isfinite(star.sigma_px),
               "places");
        demand(std::isfinite(star.luminance()) && star.luminance() > 0.0, "light");
    }
    return table.stars.size();
}

}  // namespace

std::vector<std::string> catalogue_seeds() {
    const std::string hipparcos =
        test::hipparcos_line({}) +
        test::hipparcos_line({"-1.44", "", "", "379.21", "", "06 45 08", "-16 42 58"});
    const std::string table =
        "\xef\xbb\xbfra;Dec;plx;\"vmag\";bv\r\n1;-2.5;10;3e0;\r\n# none\r\n359.9;90;-1;\"4\";~\r\n";
    const std::string hyg = std::string(test::hyg_header) +
                            "0,,,,,,Sol,0,0,0,0,0,0,-26.7,4.85,G2V,0.656,0,0,0\n"
                            "1,2,3,4,\"Gl, 5\",,,6.75,-16.7,100000,0,0,0,-1.44,1.4,A0,0.009,0,0,0\n";
    const std::string picture =
        "x,y,u,v,flux_r,flux_g,flux_b,sigma_px\n1,2,0.1,0.9,1,2,3,1.5\n3,4,.5,.5,-1,0,1e3,2\n";
    return {hipparcos, table, hyg, gzipped(hipparcos + hipparcos), picture};
}

std::size_t read_catalogue_bytes(std::string_view bytes) {
    const CatalogueFile file(bytes);
    if (kind_of_catalogue(file.path) == CatalogueKind::picture) return read_picture_bytes(file.path);
    const StarCatalogue catalogue = read_catalogue(file.path);
    demand(catalogue.rows == catalogue.bad.count + static_cast<std::int64_t>(catalogue.stars.size()),
           "every row on one side");
    const SplatSet set = star_set(catalogue, {1.0, 100.0, 4.0});
    check_consistent(set);
    demand(set.position.size() == catalogue.stars.size(), "every star");
    for (const glm::vec3& p : set.position) demand(all_finite(p) && p != glm::vec3(0.0f), "places");
    for (const glm::vec3& c : set.color)
        demand(all_finite(c) && c.x >= 0.0f && c.y >= 0.0f && c.z >= 0.0f, "light");
    return catalogue.stars.size();
}

}  // namespace astrosplat::fuzz

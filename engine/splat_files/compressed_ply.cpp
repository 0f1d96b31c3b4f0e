// SuperSplat's compressed PLY: each 256 vertices have a chunk with the bounds of their positions, logarithms
// of scales and (since 2024) colours, between which whole numbers of 8 to 11 bits lie; an element sh has
// harmonics in bytes.
#include <fmt/format.h>

#include "core/error.h"
#include "core/real.h"
#include "splat_files/packed_gaussians.h"
#include "splat_files/ply_bytes.h"
#include "splats/harmonics.h"

namespace astrosplat {
namespace {

constexpr std::uint64_t splats_a_chunk = 256;

/// The rows of an element; all its properties are of one type.
struct PackedRows {
    std::uint64_t count = 0;
    std::size_t row_bytes = 0;
    const char* begin = nullptr;
    const char* row(std::uint64_t i) const { return begin + i * row_bytes; }
};

struct CompressedPly {
    PackedRows chunks, vertices, harmonics;
    bool has_colors = false;
    std::size_t behind = 0;  // bytes after the last element
    int rest = 0;            // harmonics a channel beyond degree 0
};

PackedRows take_rows_of(const PlyElement& element, const fs::path& file, std::string_view& data) {
    std::size_t row_bytes = 0;
    for (const Column& column : element.properties) {
        const bool is_byte = column.type == NumberType::u8;
        if (column.list || !(is_byte || column.type == NumberType::f32 || column.type == NumberType::u32))
            bad_input(file, "element " + element.name, "properties float, uint or uchar",
                      quoted(std::string_view(column.name)));
        row_bytes += is_byte ? 1 : 4;
    }
    if (row_bytes == 0 || element.count > data.size() / row_bytes)
        bad_input(file, "element " + element.name,
                  fmt::format("{} rows of {} bytes", element.count, row_bytes),
                  fmt::format("{} bytes", data.size()));
    const PackedRows rows{element.count, row_bytes, data.data()};
    data.remove_prefix(std::size_t(element.count) * row_bytes);
    return rows;
}

/// Whether the first properties are of these names and the type, one behind the other.
bool begins_with(const PlyElement& element, NumberType type, std::initializer_list<std::string_view> names) {
    return element.properties.size() >= names.size() &&
           std::ranges::equal(names, std::span(element.properties).first(names.size()), {}, {},
                              &Column::name) &&
           std::ranges::all_of(element.properties,
                               [&](const Column& c) { return c.type == type && !c.list; });
}

CompressedPly compressed_ply(const PlyHeader& header, const fs::path& file) {
    CompressedPly ply;
    std::string_view data = header.data;
    if (header.format != PlyFormat::little_endian)
        bad_input(file, "header", "compressed splats as binary_little_endian", "another format");
    for (const PlyElement& element : header.elements) {
        const PackedRows rows = take_rows_of(element, file, data);
        const std::size_t properties = element.properties.size();
        bool known = true;
        if (element.name == "chunk") {
            ply.chunks = rows;
            ply.has_colors = properties == 18;
            known = (properties == 12 || properties == 18) &&
                    begins_with(element, NumberType::f32,
                                {"min_x", "min_y", "min_z", "max_x", "max_y", "max_z", "min_scale_x",
                                 "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z"});
        } else if (element.name == "vertex") {
            ply.vertices = rows;
            known = begins_with(element, NumberType::u32,
                                {"packed_position", "packed_rotation", "packed_scale", "packed_color"});
        } else if (element.name == "sh") {
            ply.harmonics = rows;
            ply.rest = int(properties / 3);
            known = (properties == 9 || properties == 24 || properties == 45) &&
                    begins_with(element, NumberType::u8, {"f_rest_0", "f_rest_1", "f_rest_2"});
        }
        if (!known) bad_input(file, "element " + element.name, "properties of compressed splats", "others");
    }
    ply.behind = data.size();
    const std::uint64_t count = ply.vertices.count, chunks = (count + splats_a_chunk - 1) / splats_a_chunk;
    if (ply.chunks.count != chunks)
        bad_input(file, "element chunk", fmt::format("{} rows for {} splats", chunks, count),
                  std::to_string(ply.chunks.count));
    if (ply.rest > 0 && ply.harmonics.count != count)
        bad_input(file, "element sh", fmt::format("{} rows", count), std::to_string(ply.harmonics.count));
    return ply;
}

double part_of(std::uint32_t word, int first, int bits) {
    const std::uint32_t most = (1u << bits) - 1;
    return double(word >> first & most) / double(most);
}

/// Three numbers of 11, 10 and 11 bits, between bounds that stand at `bounds` and three floats further.
glm::dvec3 between(const char* bounds, std::uint32_t word) {
    const glm::dvec3 t(part_of(word, 21, 11), part_of(word, 11, 10), part_of(word, 0, 11));
    glm::dvec3 value;
    for (int k = 0; k < 3; ++k) {
        const double least = number_at<float>(bounds + 4 * k), most = number_at<float>(bounds + 12 + 4 * k);
        value[k] = least * (1.0 - t[k]) + most * t[k];
    }
    return value;
}

void put_compressed(const CompressedPly& ply, SplatSet& out, std::size_t i) {
    const char* const chunk = ply.chunks.row(i / splats_a_chunk);
    const char* const vertex = ply.vertices.row(i);
    const auto word = [&](int k) { return number_at<std::uint32_t>(vertex + 4 * k); };
    out.position[i] = glm::vec3(between(chunk, word(0)));
    const glm::dvec3 scale = between(chunk + 24, word(2));
    const std::uint32_t turn = word(1), color = word(3);
    glm::vec3 others;
    for (int k = 0; k < 3; ++k) {
        others[k] = float((part_of(turn, 20 - 10 * k, 10) - 0.5) * std::sqrt(2.0));
        out.scale[i][k] = float(real::exp(scale[k]));
        double value = part_of(color, 24 - 8 * k, 8);
        if (ply.has_colors) {
            const double least = number_at<float>(chunk + 48 + 4 * k),
                         most = number_at<float>(chunk + 60 + 4 * k);
            value = least * (1.0 - value) + most * value;
        }
        mean_harmonic(out, i)[k] = float((value - 0.5) / double(harmonic_0));
    }
    const glm::vec4 q = quaternion_without(int(turn >> 30), others);  // w first
    out.rotation[i] = {q.y, q.z, q.w, q.x};
    out.alpha[i] = float(part_of(color, 0, 8));
    const char* const codes = ply.rest > 0 ? ply.harmonics.row(i) : nullptr;
    for (int j = 0; j < 3 * ply.rest; ++j) {
        const int code = byte_at(codes + j);
        const double value = code == 0 ? 0.0 : code == 255 ? 1.0 : (code + 0.5) / 256.0;
        out.harmonics[i].c[std::size_t(1 + j % ply.rest)][j / ply.rest] = float(8.0 * (value - 0.5));
    }
}

}  // namespace

bool is_compressed_ply(const PlyElement& vertex) {
    return !vertex.properties.empty() && vertex.properties[0].name == "packed_position";
}

SplatColumns compressed_ply_columns(const PlyHeader& header, const fs::path& file) {
    return gaussian_set_columns(compressed_ply(header, file).rest > 0);
}

SplatSet read_compressed_ply(const PlyHeader& header, const fs::path& file, const Progress& progress) {
    const CompressedPly ply = compressed_ply(header, file);
    warn_of_rest(file, ply.behind);
    return packed_gaussians(std::int64_t(ply.vertices.count), ply.rest > 0, file, progress,
                            [&](SplatSet& out, std::size_t i) { put_compressed(ply, out, i); });
}

}  // namespace astrosplat

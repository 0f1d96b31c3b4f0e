#include "gltf/gltf_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cstring>

#include "core/error.h"
#include "core/file.h"
#include "core/rotation.h"
#include "core/text.h"

namespace astrosplat {
namespace {

using Json = nlohmann::json;

constexpr std::uint32_t glb_magic = 0x46546c67, json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
    std::uint32_t word = 0;
    for (std::size_t i = 4; i-- > 0;) word = word << 8 | static_cast<unsigned char>(bytes[at + i]);
    return word;
}

template <class Integer>
float number_at(const char* bytes, bool normalised) {
    Integer value;
    std::memcpy(&value, bytes, sizeof value);
    if (!normalised) return float(value);
    return std::max(float(value) / float(std::numeric_limits<Integer>::max()), -1.0f);
}

/// glTF's names of types: bytes a number takes, and how it is read.
struct NumberType {
    int code;
    std::size_t size;
    float (*read)(const char* bytes, bool normalised);
};
float float_at(const char* bytes, bool) {
    float value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}
constexpr NumberType number_types[] = {{5120, 1, number_at<std::int8_t>},
                                       {5121, 1, number_at<std::uint8_t>},
                                       {5122, 2, number_at<std::int16_t>},
                                       {5123, 2, number_at<std::uint16_t>},
                                       {5126, 4, float_at}};

std::int64_t count_in(const Json& object, const char* name, std::int64_t otherwise) {
    return object.contains(name) ? object.at(name).get<std::int64_t>() : otherwise;
}

/// A URI's path with its %XX as bytes (RFC 3986); what is no such code stays.
std::string decoded(std::string_view uri) {
    std::string path;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned code = 0;
        const std::string_view digits = uri.substr(i).starts_with('%') ? uri.substr(i + 1, 2) : "";
        const char* const end = digits.data() + digits.size();
        const bool whole = digits.size() == 2 && std::from_chars(digits.data(), end, code, 16).ptr == end;
        path += whole ? char(code) : uri[i];
        i += whole ? 2 : 0;
    }
    return path;
}

}  // namespace

GltfFile::GltfFile(const fs::path& file) : file_(file) {
    std::string text = read_file(file);
    if (text.size() >= 12 && word_at(text, 0) == glb_magic) {
        std::string json;
        for (std::size_t at = 12; at + 8 <= text.size();) {
            const std::size_t size = word_at(text, at);
            const std::uint32_t type = word_at(text, at + 4);
            if (size > text.size() - at - 8) fail("chunks within the file", "one that ends after it");
            if (type == json_chunk && json.empty()) json = text.substr(at + 8, size);
            if (type == binary_chunk && binary_.empty()) binary_ = text.substr(at + 8, size);
            at += 8 + size;
        }
        text = std::move(json);
    }
    json_ = Json::parse(text, nullptr, false);
    if (!json_.is_object()) fail("glTF 2.0, JSON or binary", "something else");
    const Json version = json_.value("/asset/version"_json_pointer, Json());
    if (!version.is_string() || !version.get<std::string>().starts_with("2."))
        fail("version 2.0 of glTF", version.is_null() ? "none" : printable(version.dump()));
}

void GltfFile::fail(const std::string& expected, const std::string& found) const {
    bad_input(file_, expected, found);
}

void GltfFile::require_only(std::initializer_list<std::string_view> beginnings) const {
    for (const auto& name : json_.value("extensionsRequired", std::vector<std::string>()))
        if (std::ranges::none_of(beginnings, [&](std::string_view own) { return name.starts_with(own); }))
            fail(fmt::format("no required extensions but {}", fmt::join(beginnings, ", ")), printable(name));
}

const Json& GltfFile::element(const char* name, const Json& index) const {
    const auto list = json_.find(name);
    const std::int64_t i = index.is_number_integer() ? index.get<std::int64_t>() : -1;
    if (list == json_.end() || !list->is_array() || i < 0 || i >= std::ssize(*list))
        fail(fmt::format("a number of one of its {}", name), printable(index.dump()));
    return (*list)[i];
}

const std::string& GltfFile::buffer(const Json& index) {
    const Json& described = element("buffers", index);
    const auto i = index.get<std::int64_t>();
    const auto known = buffers_.find(i);
    if (known != buffers_.end()) return known->second;
    std::string bytes;
    if (!described.contains("uri")) {
        bytes = binary_;
    } else {
        const auto uri = described.at("uri").get<std::string>();
        if (uri.starts_with("data:")) {
            const std::size_t comma = uri.find(";base64,");
            const std::optional<std::string> read =
                comma == std::string::npos ? std::nullopt
                                           : bytes_of_base64(std::string_view(uri).substr(comma + 8));
            if (!read) fail("base64 in a buffer's data:", "something else");
            bytes = *read;
        } else {
            // A foreign file may only name files in its own folder.
            const std::string path = decoded(uri);
            const fs::path name = fs::path(path).lexically_normal();
            if (uri.find(':') != uri.npos || path.find('\0') != path.npos || name.is_absolute() ||
                name.string().starts_with(".."))
                fail("buffers in or beside the file", "'" + printable(uri) + "'");
            bytes = read_file(file_.parent_path() / name);
        }
    }
    return buffers_.emplace(i, std::move(bytes)).first->second;
}

std::vector<float> GltfFile::numbers(const Json& accessor_index, int components) {
    const Json& accessor = element("accessors", accessor_index);
    if (accessor.contains("sparse")) fail("accessors that are not sparse", "a sparse one");
    const Json& view = element("bufferViews", accessor.value("bufferView", Json()));
    const std::string& bytes = buffer(view.value("buffer", Json()));
    const int code = accessor.at("componentType").get<int>();
    const auto type = std::ranges::find(number_types, code, &NumberType::code);
    if (type == std::end(number_types))
        fail("numbers of one of the types 5120 to 5123 or 5126", std::to_string(code));
    const std::size_t own = type->size * std::size_t(components);
    const std::int64_t count = count_in(accessor, "count", 0), view_size = count_in(view, "byteLength", 0),
                       view_at = count_in(view, "byteOffset", 0), at = count_in(accessor, "byteOffset", 0),
                       stride = count_in(view, "byteStride", std::int64_t(own));
    const std::int64_t size = std::ssize(bytes);
    const bool fits = count > 0 && view_at >= 0 && view_at <= size && view_size >= 0 &&
                      view_size <= size - view_at && stride >= std::int64_t(own) && at >= 0 &&
                      at <= view_size - std::int64_t(own) &&
                      count - 1 <= (view_size - std::int64_t(own) - at) / stride;
    if (!fits) fail("an accessor within its buffer", fmt::format("{} elements beyond it", count));
    const bool normalised = accessor.value("normalized", false);
    std::vector<float> numbers;
    numbers.reserve(std::size_t(count) * std::size_t(components));
    for (std::int64_t i = 0; i < count; ++i)
        for (int c = 0; c < components; ++c)
            numbers.push_back(type->read(
                bytes.data() + view_at + at + i * stride + c * std::int64_t(type->size), normalised));
    return numbers;
}

GltfNode node_of(const GltfFile& file, const Json& json) {
    const auto read = [&](const char* name, std::size_t count, const auto& take) {
        if (!json.contains(name)) return;
        const auto numbers = json.at(name).get<std::vector<double>>();
        if (numbers.size() != count)
            file.fail(fmt::format("{} numbers as a node's {}", count, name), std::to_string(numbers.size()));
        for (std::size_t i = 0; i < count; ++i) take(int(i), numbers[i]);
    };
    GltfNode node;
    read("translation", 3, [&](int i, double number) { node.translation[i] = number; });
    read("scale", 3, [&](int i, double number) { node.scale[i] = number; });
    read("rotation", 4, [&](int i, double number) { node.rotation[i] = number; });
    if (json.contains("matrix")) node.matrix.emplace();
    read("matrix", 16, [&](int i, double number) { (*node.matrix)[i / 4][i % 4] = number; });
    return node;
}

glm::dmat4 GltfNode::parent_from_node() const {
    if (matrix) return *matrix;
    const glm::dmat3 axes = matrix_of_quaternion(rotation);
    return {glm::dvec4(axes[0] * scale.x, 0.0), glm::dvec4(axes[1] * scale.y, 0.0),
            glm::dvec4(axes[2] * scale.z, 0.0), glm::dvec4(translation, 1.0)};
}

}  // namespace astrosplat

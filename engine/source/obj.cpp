// Wavefront OBJ. In: a file. Out: Mesh. tinyobjloader reads the materials; the geometry is read here, because
// version 2.0.0rc10 refuses whole files for "1//" (which exporters write), and takes an incomplete vertex, a
// face of two corners and an index out of range without a word. (Its numbers agree with ours.)
#include "source/mesh.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <map>
#include <sstream>

#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/text.h"

namespace astrosplat {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::int64_t no_index = -1;
constexpr std::int64_t max_elements = 0xfffffffe;  // indices are 32 bit, and the last one says "none"

struct Corner {
    std::int64_t position;  // from 0
    std::int64_t uv;        // from 0, or no_index
};

struct Polygon {
    std::size_t first_triangle;  // of the n - 2 that stand for it
    std::vector<Corner> corners;
    std::int64_t line;
};

// The highest index used and where: faces may come before the vertices they name, so the check waits
// for the end.
struct Highest {
    std::int64_t index = no_index;
    std::int64_t line = 0;

    void note(std::int64_t i, std::int64_t at_line) {
        if (i > index) *this = {i, at_line};
    }
};

struct Material {
    fs::path map;                    // map_Kd
    std::optional<glm::vec3> color;  // Kd, linear
};

struct Reader {
    fs::path file;
    Mesh mesh;
    std::int64_t line = 0;
    std::vector<Polygon> polygons;  // those with more than three corners
    Highest position, uv;
    std::map<std::string, Material> materials;
    std::vector<fs::path> libraries;                                           // the MTL files read
    std::map<std::tuple<fs::path, float, float, float>, std::uint32_t> index;  // in mesh.maps
    std::uint32_t material = 0;
    bool material_chosen = false;
    std::int64_t others = 0;  // lines, points and free forms
};

[[noreturn]] void bad_line(const Reader& r, std::string_view expected, std::string_view found) {
    bad_input(r.file, std::to_string(r.line), expected, found);
}

void split(std::string_view text, Words& words) {
    words.clear();
    for (std::size_t at = 0; (at = text.find_first_not_of(" \t\r", at)) != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(" \t\r", at), text.size());
        words.push_back(text.substr(at, end - at));
        at = end;
    }
}

float coordinate(const Reader& r, std::string_view word) {
    const std::optional<double> value = parse_double(word);
    if (!value || !std::isfinite(float(*value))) bad_line(r, "a finite number", fmt::format("'{}'", word));
    return float(*value);
}

// Of vertices without one until all are read.
constexpr glm::vec3 no_color(std::numeric_limits<float>::infinity());

void read_position(Reader& r, const Words& words) {
    if (words.size() < 4) bad_line(r, "three coordinates after 'v'", fmt::format("{}", words.size() - 1));
    r.mesh.positions.emplace_back(coordinate(r, words[1]), coordinate(r, words[2]), coordinate(r, words[3]));
    if (words.size() < 7) return;
    r.mesh.vertex_colors.resize(r.mesh.positions.size(), no_color);
    for (int c = 0; c < 3; ++c) r.mesh.vertex_colors.back()[c] = coordinate(r, words[4 + std::size_t(c)]);
}

void read_uv(Reader& r, const Words& words) {
    if (words.size() < 3)
        bad_line(r, "two texture coordinates after 'vt'", fmt::format("{}", words.size() - 1));
    r.mesh.uvs.emplace_back(coordinate(r, words[1]), coordinate(r, words[2]));
}

std::string plural(std::string_view what) { return what == "vertex" ? "vertices" : std::string(what) + "s"; }

// OBJ counts from 1, and from the end with negative numbers.
std::int64_t resolve(const Reader& r, std::string_view text, std::size_t count, const char* what) {
    const std::optional<std::int64_t> index = parse_int64(text);
    if (!index || *index == 0 || *index > max_elements)
        bad_line(r, fmt::format("the number of a {}", what), fmt::format("'{}'", text));
    if (*index > 0) return *index - 1;
    const std::int64_t resolved = std::int64_t(count) + *index;
    if (resolved < 0)
        bad_line(r, fmt::format("one of the {} {} so far", count, plural(what)), fmt::format("{}", *index));
    return resolved;
}

// position, position/uv, position//normal or position/uv/normal
Corner read_corner(Reader& r, std::string_view word) {
    const std::size_t first = word.find('/');
    Corner corner{resolve(r, word.substr(0, first), r.mesh.positions.size(), "vertex"), no_index};
    r.position.note(corner.position, r.line);
    if (first == std::string_view::npos) return corner;
    const std::size_t second = word.find('/', first + 1);
    const std::string_view uv =
        word.substr(first + 1, second == std::string_view::npos ? second : second - first - 1);
    const bool normal_only = uv.empty() && second != std::string_view::npos;
    if (!normal_only) {
        corner.uv = resolve(r, uv, r.mesh.uvs.size(), "texture coordinate");
        r.uv.note(corner.uv, r.line);
    }
    const bool normal = second != std::string_view::npos && second + 1 < word.size();  // some write "1//"
    if (normal && !parse_int64(word.substr(second + 1)))
        bad_line(r, "the number of a normal", fmt::format("'{}'", word));
    return corner;
}

Mesh::Triangle triangle_of(const Reader& r, const Corner& a, const Corner& b, const Corner& c) {
    const auto uv = [](const Corner& k) { return k.uv < 0 ? Mesh::no_uv : std::uint32_t(k.uv); };
    const auto position = [](const Corner& k) { return std::uint32_t(k.position); };
    return {{position(a), position(b), position(c)}, {uv(a), uv(b), uv(c)}, r.material};
}

std::uint32_t index_of(Reader& r, const Material& material) {
    const glm::vec3 color = material.color.value_or(glm::vec3(-1.0f));
    const auto [found, fresh] =
        r.index.try_emplace({material.map, color.x, color.y, color.z}, std::uint32_t(r.mesh.maps.size()));
    if (fresh) {
        r.mesh.maps.push_back(material.map);
        r.mesh.colors.push_back(material.color);
    }
    return found->second;
}

void read_face(Reader& r, const Words& words) {
    if (words.size() < 4)
        bad_line(r, "at least three corners after 'f'", fmt::format("{}", words.size() - 1));
    std::vector<Corner> corners;
    for (std::size_t i = 1; i < words.size(); ++i) corners.push_back(read_corner(r, words[i]));
    for (const Corner& corner : corners)
        if ((corner.uv < 0) != (corners[0].uv < 0))
            bad_line(r, "texture coordinates at all corners of a face or at none", "a mixture");
    if (!r.material_chosen) {
        r.material = index_of(r, {});
        r.material_chosen = true;
    }
    const std::size_t first = r.mesh.triangles.size();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        r.mesh.triangles.push_back(triangle_of(r, corners[0], corners[i], corners[i + 1]));
    if (corners.size() > 3) r.polygons.push_back({first, std::move(corners), r.line});
}

// The rest of a line behind its first word.
std::string rest_of(std::string_view text, const Words& words) {
    return std::string(trim(text.substr(std::size_t(words[0].data() - text.data()) + words[0].size())));
}

fs::path native(std::string name) {
    std::ranges::replace(name, '\\', '/');
    return name;
}

// One logical line: a backslash at the end continues it on the next. Advances `text` and the line count.
std::string_view next_line(std::string_view& text, std::string& joined, std::int64_t& lines) {
    joined.clear();
    for (;;) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++lines;
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        const bool continued = !line.empty() && line.back() == '\\' && !text.empty();
        if (!continued && joined.empty()) return line;
        joined.append(line.substr(0, line.size() - (continued ? 1 : 0)));
        if (!continued) return joined;
        joined.push_back(' ');
    }
}

// Numbers behind words[i] that are other than `usual`.
bool differs(const Words& words, std::size_t i, double usual) {
    for (std::optional<double> value; ++i < words.size() && (value = parse_double(words[i]));)
        if (*value != usual) return true;
    return false;
}

// Of a material's line: light of its own, transparency, and where or how a picture lies on it.
bool is_unfollowed(const Words& words) {
    const std::string_view key = words[0];
    if (key == "map_Ke" || key == "map_d") return true;
    if (key == "Ke" || key == "Tr") return differs(words, 0, 0.0);
    if (key == "d") return differs(words, 0, 1.0);
    for (std::size_t i = 1; key == "map_Kd" && i < words.size(); ++i)
        if ((words[i] == "-s" && differs(words, i, 1.0)) || (words[i] == "-o" && differs(words, i, 0.0)) ||
            (words[i] == "-t" && differs(words, i, 0.0)) || words[i] == "-mm" ||
            (words[i] == "-clamp" && i + 1 < words.size() && words[i + 1] == "on"))
            return true;
    return false;
}

// The Kd of each material: tinyobjloader does not tell those that are not there.
void read_material_colors(Reader& r, const fs::path& file, std::string_view content) {
    Words words;
    std::string name, joined;
    for (std::int64_t lines = 0; !content.empty();) {
        const std::string_view text = next_line(content, joined, lines);
        split(text, words);
        if (!words.empty() && words[0] == "newmtl") name = rest_of(text, words);
        if (!words.empty() && is_unfollowed(words))
            log_warning(fmt::format("{}:{}: '{}' is not followed", file.string(), lines, trim(text)));
        if (words.size() < 2 || words[0] != "Kd") continue;
        glm::vec3 color;
        bool whole = words.size() == 2 || words.size() >= 4;
        for (int c = 0; whole && c < 3; ++c) {
            const auto value = parse_double(words[words.size() == 2 ? 1 : std::size_t(c) + 1]);
            whole = value && std::isfinite(float(*value)) && *value >= 0.0;
            if (whole) color[c] = float(*value);
        }
        if (whole)
            r.materials[name].color = color;
        else
            log_warning(fmt::format("{}:{}: '{}' is not followed", file.string(), lines, trim(text)));
    }
}

// False where there is no such file.
bool load_materials(Reader& r, const std::string& name) {
    const fs::path file = r.file.parent_path() / native(name);
    std::string content;
    try {
        content = read_file(file);
    } catch (const InputError&) {
        return false;
    }
    std::istringstream in(content);
    std::map<std::string, int> ids;
    std::vector<tinyobj::material_t> materials;
    std::string warning, problem;
    tinyobj::LoadMtl(&ids, &materials, &in, &warning, &problem);
    r.libraries.push_back(file);
    for (const auto& [material, id] : ids) {
        const std::string& map = materials[id].diffuse_texname;
        r.materials[material] = {map.empty() ? fs::path() : file.parent_path() / native(map), {}};
    }
    read_material_colors(r, file, content);
    return true;
}

// The line may hold several names, or one with blanks in it.
void read_mtllib(Reader& r, std::string_view text, const Words& words) {
    if (load_materials(r, rest_of(text, words))) return;
    std::vector<std::string_view> missing;
    for (std::size_t i = 1; i < words.size(); ++i)
        if (words.size() == 2 || !load_materials(r, std::string(words[i]))) missing.push_back(words[i]);
    if (!missing.empty())
        log_warning(fmt::format("{}:{}: material library '{}' not found", r.file.string(), r.line,
                                fmt::join(missing, "', '")));
}

void use_material(Reader& r, const std::string& name) {
    const auto found = r.materials.find(name);
    r.material = index_of(r, found == r.materials.end() ? Material{} : found->second);
    r.material_chosen = true;
}

void read_line(Reader& r, std::string_view text, Words& words) {
    split(text, words);
    if (words.empty()) return;
    if (words[0] == "v") read_position(r, words);
    if (words[0] == "vt") read_uv(r, words);
    if (words[0] == "f") read_face(r, words);
    if (words[0] == "mtllib") read_mtllib(r, text, words);
    if (words[0] == "usemtl") use_material(r, rest_of(text, words));
    if (words[0] == "curv" || words[0] == "surf" || words[0] == "l" || words[0] == "p") ++r.others;
}

void check_range(Reader& r, const Highest& highest, std::size_t count, const char* what) {
    if (highest.index < std::int64_t(count)) return;
    r.line = highest.line;
    bad_line(r, fmt::format("one of the file's {} {}", count, plural(what)),
             fmt::format("number {}", highest.index + 1));
}

// Replaces the fans that stand for polygons, now that all positions are known.
void triangulate_polygons(Reader& r) {
    std::vector<glm::vec3> corners;
    for (const Polygon& polygon : r.polygons) {
        corners.clear();
        for (const Corner& c : polygon.corners) corners.push_back(r.mesh.positions[c.position]);
        const auto triples = triangulate(corners);
        r.line = polygon.line;
        if (triples.empty())
            bad_line(r, fmt::format("at most {} corners where a face is not convex", max_concave_corners),
                     fmt::format("{}", corners.size()));
        for (std::size_t i = 0; i < triples.size(); ++i) {
            const auto& [a, b, c] = triples[i];
            Mesh::Triangle& triangle = r.mesh.triangles[polygon.first_triangle + i];
            r.material = triangle.material;
            triangle = triangle_of(r, polygon.corners[a], polygon.corners[b], polygon.corners[c]);
        }
    }
}

void check_whole(Reader& r) {
    const std::string name = r.file.string();
    if (r.mesh.positions.empty()) bad_input(name, "an OBJ mesh with vertices ('v x y z')", "none");
    if (r.mesh.triangles.empty()) bad_input(name, "an OBJ mesh with faces ('f')", "none");
    const std::size_t most = std::max({r.mesh.positions.size(), r.mesh.uvs.size(), r.mesh.triangles.size()});
    if (most > std::size_t(max_elements))
        bad_input(name, fmt::format("at most {} vertices and triangles", max_elements),
                  fmt::format("{}", most));
    check_range(r, r.position, r.mesh.positions.size(), "vertex");
    check_range(r, r.uv, r.mesh.uvs.size(), "texture coordinate");
}

// Some programs write codes of 8 bits: whole numbers, and some beyond 1.
void scale_vertex_colors(Reader& r) {
    bool beyond = false, codes = true;
    for (const glm::vec3& color : r.mesh.vertex_colors)
        for (int c = 0; c < 3 && color != no_color; ++c) {
            beyond = beyond || color[c] > 1.0f;
            codes = codes && color[c] == std::floor(color[c]) && color[c] >= 0.0f && color[c] <= 255.0f;
        }
    if (!beyond || !codes) return;
    for (glm::vec3& color : r.mesh.vertex_colors) color /= 255.0f;
    log_warning(
        fmt::format("{}: its vertex colours are whole numbers: taken as parts of 255", r.file.string()));
}

// Calls read(line) for every logical line; r.line is the number of its first.
template <class Read>
void for_each_line(Reader& r, std::string_view text, const Progress& progress, Read&& read) {
    const auto size = double(text.size());
    if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);  // byte order mark
    for (std::string joined; !text.empty();) {
        std::int64_t lines = 0;
        const std::string_view line = next_line(text, joined, lines);
        ++r.line;
        read(line);
        r.line += lines - 1;
        if (r.line % 4096 != 0) continue;
        progress.check();
        progress.at(1.0 - double(text.size()) / size);
    }
}

}  // namespace

Mesh load_obj(const fs::path& file, const Progress& progress) {
    const std::string content = read_file(file, progress);
    Reader r;
    r.file = file;
    r.mesh.name = file.string();
    Words words;
    for_each_line(r, content, progress, [&](std::string_view line) { read_line(r, line, words); });
    check_whole(r);
    triangulate_polygons(r);
    if (r.mesh.maps.size() == 1 && r.mesh.maps[0].empty() && !r.mesh.colors[0]) {
        r.mesh.maps.clear();
        r.mesh.colors.clear();
    }
    if (r.others > 0)
        log_warning(fmt::format("{}: its {} that are no faces (l, p, curv, surf) are not followed",
                                file.string(), counted(r.others, "element")));
    scale_vertex_colors(r);
    if (!r.mesh.vertex_colors.empty()) r.mesh.vertex_colors.resize(r.mesh.positions.size(), no_color);
    std::ranges::replace(r.mesh.vertex_colors, no_color, glm::vec3(1.0f));
    return std::move(r.mesh);
}

std::vector<fs::path> obj_materials(const fs::path& file, const Progress& progress) {
    const std::string content = read_file(file, progress);
    Reader r;
    r.file = file;
    Words words;
    for_each_line(r, content, {{}, progress.cancelled}, [&](std::string_view line) {
        if (line.find("mtllib") == std::string_view::npos) return;
        split(line, words);
        if (words[0] == "mtllib") read_mtllib(r, line, words);
    });
    std::vector<fs::path> files = r.libraries;
    for (const auto& [name, material] : r.materials) files.push_back(material.map);
    std::error_code ignored;
    std::erase_if(files, [&](const fs::path& each) { return !fs::is_regular_file(each, ignored); });
    return files;
}

}  // namespace astrosplat

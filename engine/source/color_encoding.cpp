// lcms2 reads profiles; curves and matrices are computed here, for its own arithmetic is the C library's.
#include "source/color_encoding.h"

#include <fmt/format.h>
#include <lcms2.h>

#include <glm/matrix.hpp>
#include <map>

#include "core/color.h"
#include "core/file.h"
#include "core/log.h"
#include "core/real.h"
#include "core/text.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

using Kind = TransferCurve::Kind;

// ITU-R BT.2100-2, table 4, in units of BT.2408's reference white of 203 cd/m^2.
double from_pq(double x) {
    constexpr double m1 = 1305.0 / 8192.0, m2 = 2523.0 / 32.0, c1 = 107.0 / 128.0, c2 = 2413.0 / 128.0,
                     c3 = 2392.0 / 128.0, reference_white = 203.0 / 10000.0;
    const double power = real::pow(x, 1.0 / m2);
    return real::pow(std::max(power - c1, 0.0) / (c2 - c3 * power), 1.0 / m1) / reference_white;
}

// ITU-R BT.2100-2, table 5: light of the scene; BT.2408's reference white is at 3/4 of the signal.
double hlg_scene(double x) {
    constexpr double a = 0.17883277, b = 1.0 - 4.0 * a, c = 0.55991073;
    return x <= 0.5 ? x * x / 3.0 : (real::exp((x - c) / a) + b) / 12.0;
}

TransferCurve gamma_curve(double gamma) {
    TransferCurve curve;
    if (std::fabs(gamma - 1.0) > 1e-6) {
        curve.kind = Kind::parametric;
        curve.parameters[0] = gamma;
    }
    return curve;
}

// ICC's five kinds of parametric curves as the last of them.
TransferCurve parametric_curve(int type, const double* p) {
    TransferCurve curve{Kind::parametric, {p[0], 1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, {}};
    auto& [g, a, b, c, d, e, f] = curve.parameters;
    if (type == 1) return gamma_curve(p[0]);
    a = p[1];
    b = p[2];
    d = type <= 3 ? -b / a : p[4];
    if (type == 3) e = f = p[3];
    if (type >= 4) c = p[3];
    if (type == 5) {
        e = p[5];
        f = p[6];
    }
    return curve;
}

TransferCurve curve_of(const cmsToneCurve* curve) {
    const int type = cmsGetToneCurveParametricType(curve);
    if (type >= 1 && type <= 5) return parametric_curve(type, cmsGetToneCurveParams(curve));
    const std::uint32_t size = cmsGetToneCurveEstimatedTableEntries(curve);
    const std::uint16_t* const values = cmsGetToneCurveEstimatedTable(curve);
    TransferCurve table{Kind::table, {}, {}};
    for (std::uint32_t i = 0; i < size; ++i) table.table.push_back(float(values[i]) / 65535.0f);
    return size >= 2 ? table : TransferCurve{};
}

bool is_near(const TransferCurve& curve, const TransferCurve& other) {
    constexpr double tolerance = 1e-3;  // profiles have 8 or 16 bits, and tables of few points
    for (int i = 0; i <= 64; ++i)
        if (!(std::fabs(curve(i / 64.0) - other(i / 64.0)) < tolerance)) return false;
    return true;
}

void snap_to_known(ColorEncoding& encoding) {
    constexpr double tolerance = 2e-3;  // of rounded primaries
    bool same = true;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) same = same && std::fabs(encoding.to_rec709[i][k] - (i == k)) < tolerance;
    if (same) encoding.to_rec709 = glm::dmat3(1.0);
    for (const Kind kind : {Kind::srgb, Kind::linear})
        for (TransferCurve& curve : encoding.curves)
            if (curve.kind != kind && is_near(curve, TransferCurve{kind, {}, {}})) curve = {kind, {}, {}};
}

struct CloseProfile {
    void operator()(void* profile) const { cmsCloseProfile(profile); }
};

std::string description_of(cmsHPROFILE profile) {
    std::array<char, 128> text{};
    cmsGetProfileInfoASCII(profile, cmsInfoDescription, "en", "US", text.data(), text.size());
    return std::string(trim(text.data()));
}

// ITU-T H.273, table 2.
std::optional<Chromaticities> primaries_of_code(int code) {
    constexpr glm::dvec2 d65{0.3127, 0.3290};
    if (code == 1) return rec709_chromaticities;
    if (code == 4) return Chromaticities{{0.67, 0.33}, {0.21, 0.71}, {0.14, 0.08}, {0.310, 0.316}};
    if (code == 5) return Chromaticities{{0.64, 0.33}, {0.29, 0.60}, {0.15, 0.06}, d65};
    if (code == 6 || code == 7) return Chromaticities{{0.630, 0.340}, {0.310, 0.595}, {0.155, 0.070}, d65};
    if (code == 9) return Chromaticities{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, d65};
    if (code == 11) return Chromaticities{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.314, 0.351}};
    if (code == 12) return Chromaticities{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, d65};
    return {};
}

// ITU-T H.273, table 3. BT.709's and its kin's are undone as cameras apply them.
std::optional<TransferCurve> transfer_of_code(int code) {
    if (code == 1 || code == 6 || code == 14 || code == 15)
        return parametric_curve(4,
                                std::array{1.0 / 0.45, 1.0 / 1.099, 0.099 / 1.099, 1.0 / 4.5, 0.081}.data());
    if (code == 4) return gamma_curve(2.2);
    if (code == 5) return gamma_curve(2.8);
    if (code == 8) return TransferCurve{};
    if (code == 13) return TransferCurve{Kind::srgb, {}, {}};
    if (code == 16) return TransferCurve{Kind::pq, {}, {}};
    if (code == 18) return TransferCurve{Kind::hlg, {}, {}};
    return {};
}

std::shared_ptr<const ColorEncoding> encoding_of(const Chromaticities& set, const TransferCurve& curve,
                                                 std::string name) {
    ColorEncoding encoding{
        std::move(name), {curve, curve, curve}, primaries_matrix(set, rec709_chromaticities), {}};
    snap_to_known(encoding);
    return std::make_shared<const ColorEncoding>(std::move(encoding));
}

std::uint32_t big_endian(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8U | std::uint8_t(bytes[at + i]);
    return value;
}

// The chunks of a PNG file before its pixels, by name.
std::map<std::string, std::string, std::less<>> png_chunks(const fs::path& file) {
    constexpr std::size_t most_bytes = std::size_t{1} << 20;  // profiles come first, and are smaller
    const std::string bytes = read_beginning(file, most_bytes);
    std::map<std::string, std::string, std::less<>> chunks;
    for (std::size_t at = 8; at + 12 <= bytes.size();) {
        const std::size_t size = big_endian(bytes, at);
        const std::string name = bytes.substr(at + 4, 4);
        if (name == "IDAT" || size > bytes.size() - at - 12) break;
        chunks.emplace(name, bytes.substr(at + 8, size));
        at += size + 12;
    }
    return chunks;
}

std::shared_ptr<const ColorEncoding> cicp_encoding(std::string_view code, std::string& problem) {
    const auto byte = [&](std::size_t i) { return int(std::uint8_t(code[i])); };
    const auto primaries = primaries_of_code(byte(0));
    const auto transfer = transfer_of_code(byte(1));
    const std::string name = fmt::format("cICP {}/{}/{}/{}", byte(0), byte(1), byte(2), byte(3));
    if (primaries && transfer && byte(2) == 0 && byte(3) == 1)
        return encoding_of(*primaries, *transfer, name);
    problem = name;
    return {};
}

}  // namespace

double TransferCurve::operator()(double x) const {
    if (x < 0.0) return -(*this)(-x);
    if (kind == Kind::srgb) return real::srgb_to_linear(x);
    if (kind == Kind::pq) return from_pq(x);
    if (kind == Kind::hlg) return hlg_scene(x) / hlg_scene(0.75);
    if (kind == Kind::parametric) {
        const auto& [g, a, b, c, d, e, f] = parameters;
        return x >= d ? real::pow(std::max(a * x + b, 0.0), g) + e : c * x + f;
    }
    if (kind == Kind::table) {
        const double at = std::min(x, 1.0) * double(table.size() - 1), below = std::floor(at);
        const auto i = std::size_t(below);
        const double lower = table[i], upper = table[std::min(i + 1, table.size() - 1)];
        return lower + (upper - lower) * (at - below);
    }
    return x;
}

bool ColorEncoding::is_rec709(TransferCurve::Kind kind) const {
    return to_rec709 == glm::dmat3(1.0) &&
           std::ranges::all_of(curves, [&](const TransferCurve& curve) { return curve.kind == kind; });
}

std::shared_ptr<const ColorEncoding> icc_encoding(std::span<const std::uint8_t> bytes, std::string& problem) {
    const std::unique_ptr<void, CloseProfile> profile(
        cmsOpenProfileFromMem(bytes.data(), static_cast<cmsUInt32Number>(bytes.size())));
    if (!profile) {
        problem = "ICC profile, which is damaged,";
        return {};
    }
    ColorEncoding encoding;
    encoding.name = fmt::format("ICC profile '{}'", description_of(profile.get()));
    const auto tag = [&](cmsTagSignature name) { return cmsReadTag(profile.get(), name); };
    if (cmsGetColorSpace(profile.get()) == cmsSigGrayData) {
        if (const void* curve = tag(cmsSigGrayTRCTag)) {
            encoding.curves.fill(curve_of(static_cast<const cmsToneCurve*>(curve)));
            snap_to_known(encoding);
            return std::make_shared<const ColorEncoding>(std::move(encoding));
        }
    }
    constexpr std::array columns{cmsSigRedColorantTag, cmsSigGreenColorantTag, cmsSigBlueColorantTag};
    constexpr std::array curves{cmsSigRedTRCTag, cmsSigGreenTRCTag, cmsSigBlueTRCTag};
    const bool plain = cmsIsMatrixShaper(profile.get()) && cmsGetColorSpace(profile.get()) == cmsSigRgbData &&
                       !cmsIsTag(profile.get(), cmsSigAToB0Tag);
    glm::dmat3 to_xyz(0.0);
    for (int i = 0; plain && i < 3; ++i) {
        const auto* const xyz = static_cast<const cmsCIEXYZ*>(tag(columns[i]));
        const auto* const curve = static_cast<const cmsToneCurve*>(tag(curves[i]));
        if (!xyz || !curve) break;
        to_xyz[i] = {xyz->X, xyz->Y, xyz->Z};
        encoding.curves[i] = curve_of(curve);
    }
    if (!(std::fabs(glm::determinant(to_xyz)) > 1e-6)) {
        problem = encoding.name + ", which is not one of matrix and curves,";
        return {};
    }
    // Rec. 709 under D50, to which profiles are adapted by Bradford's matrix: IEC 61966-2-1 as profiles have
    // it.
    const glm::dmat3 rec709_d50({0.4360747, 0.2225045, 0.0139322}, {0.3850649, 0.7168786, 0.0971045},
                                {0.1430804, 0.0606169, 0.7141733});
    encoding.to_rec709 = glm::inverse(rec709_d50) * to_xyz;
    snap_to_known(encoding);
    return std::make_shared<const ColorEncoding>(std::move(encoding));
}

std::shared_ptr<const ColorEncoding> chromaticity_encoding(std::span<const float, 8> xy, TransferCurve curve,
                                                           std::string name, std::string& problem) {
    if (std::ranges::equal(xy, xyz_chromaticities)) {
        // IEC 61966-2-1, by columns.
        const glm::dmat3 matrix({3.2406, -0.9689, 0.0557}, {-1.5372, 1.8758, -0.2040},
                                {-0.4986, 0.0415, 1.0570});
        return std::make_shared<const ColorEncoding>(ColorEncoding{"XYZ", {curve, curve, curve}, matrix, {}});
    }
    problem = name;
    const auto at = [&](std::size_t i) { return glm::dvec2(xy[2 * i], xy[2 * i + 1]); };
    const Chromaticities set{at(0), at(1), at(2), at(3)};
    for (const glm::dvec2& c : {set.red, set.green, set.blue, set.white})
        if (!(std::fabs(c.x) <= 2.0 && std::fabs(c.y) <= 2.0 && c.y != 0.0)) return {};
    const glm::dmat3 matrix = primaries_matrix(set, rec709_chromaticities);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            if (!(std::fabs(matrix[i][k]) < 1e3)) return {};
    problem.clear();
    return encoding_of(set, curve, std::move(name));
}

std::shared_ptr<const ColorEncoding> adobe_rgb_encoding() {
    return encoding_of({{0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}, {0.3127, 0.3290}},
                       gamma_curve(563.0 / 256.0), "Adobe RGB (1998)");
}

std::shared_ptr<const ColorEncoding> named_encoding(std::string_view name, double gamma) {
    if (name == "Linear") return encoding_of(rec709_chromaticities, {}, "Linear");
    if (name == "Rec709") return encoding_of(rec709_chromaticities, *transfer_of_code(1), "Rec709");
    if (name.starts_with("Gamma") && gamma > 0.01 && gamma < 100.0)
        return encoding_of(rec709_chromaticities, gamma_curve(gamma), std::string(name));
    return {};
}

std::shared_ptr<const ColorEncoding> tiff_encoding(const TiffColors& tiff, double largest,
                                                   std::string& problem) {
    if (!tiff.primaries && tiff.transfer[0].empty()) return {};
    const auto set =
        tiff.primaries.value_or(std::array{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f});
    const auto plain =
        chromaticity_encoding(set, {largest > 0.0 ? Kind::srgb : Kind::linear, {}, {}},
                              tiff.primaries ? "PrimaryChromaticities" : "TransferFunction", problem);
    if (!plain || tiff.transfer[0].empty()) return plain;
    ColorEncoding encoding = *plain;
    for (std::size_t c = 0; c < 3; ++c) encoding.curves[c] = {Kind::table, {}, tiff.transfer[c]};
    snap_to_known(encoding);
    return std::make_shared<const ColorEncoding>(std::move(encoding));
}

std::shared_ptr<const ColorEncoding> png_encoding(const fs::path& file, bool has_profile,
                                                  std::string& problem) {
    const auto chunks = png_chunks(file);
    const auto chunk = [&](std::string_view name, std::size_t size) -> std::string_view {
        const auto found = chunks.find(name);
        return found != chunks.end() && found->second.size() == size ? found->second : std::string_view();
    };
    if (const std::string_view code = chunk("cICP", 4); !code.empty()) return cicp_encoding(code, problem);
    if (chunks.contains("iCCP") && !has_profile) problem = "ICC profile, which libpng refuses,";
    if (chunks.contains("iCCP") || !chunk("sRGB", 1).empty()) return {};
    const std::string_view gamma = chunk("gAMA", 4), primaries = chunk("cHRM", 32);
    if (gamma.empty() && primaries.empty()) return {};
    TransferCurve curve{Kind::srgb, {}, {}};
    if (!gamma.empty() && big_endian(gamma, 0) > 0) curve = gamma_curve(1e5 / double(big_endian(gamma, 0)));
    if (primaries.empty()) return encoding_of(rec709_chromaticities, curve, "gAMA");
    std::array<float, 8> xy{};
    constexpr std::array<std::size_t, 8> order{2, 3, 4, 5, 6, 7, 0, 1};  // white comes first there
    for (std::size_t i = 0; i < 8; ++i) xy[i] = float(big_endian(primaries, 4 * order[i])) / 1e5f;
    return chromaticity_encoding(xy, curve, gamma.empty() ? "cHRM" : "gAMA and cHRM", problem);
}

std::int64_t png_frames(const fs::path& file) {
    const auto chunks = png_chunks(file);
    const auto control = chunks.find("acTL");  // of an animation
    return control != chunks.end() && control->second.size() == 8 ? big_endian(control->second, 0) : 1;
}

std::shared_ptr<const ColorEncoding> with_tables(std::shared_ptr<const ColorEncoding> encoding,
                                                 double max_integer) {
    if (!encoding || (max_integer != 255.0 && max_integer != 65535.0)) return encoding;
    ColorEncoding tabled = *encoding;
    for (std::size_t c = 0; c < 3; ++c)
        for (double i = 0.0; i <= max_integer; i += 1.0)
            tabled.of_integers[c].push_back(float(tabled.curves[c](i / max_integer)));
    return std::make_shared<const ColorEncoding>(std::move(tabled));
}

void decode_colors(Image& image, const ColorEncoding& encoding, bool associated) {
    const std::array<std::vector<float>, 3>& tables = encoding.of_integers;
    const float largest = float(tables[0].size()) - 1.0f;
    const bool turns = encoding.to_rec709 != glm::dmat3(1.0);
    change_pixels(image, [&](float* p) {
        const float alpha = associated && image.channels == 4 ? p[3] : 1.0f;
        if (!(alpha > 0.0f)) return;
        glm::dvec3 light;
        for (int c = 0; c < 3; ++c) {
            if (largest > 0.0f && !associated)
                light[c] = tables[c][std::size_t(std::clamp(p[c], 0.0f, 1.0f) * largest + 0.5f)];
            else
                light[c] = encoding.curves[c](double(p[c] / alpha));
        }
        if (turns) light = encoding.to_rec709 * light;
        for (int c = 0; c < 3; ++c) p[c] = alpha * float(light[c]);
    });
}

}  // namespace astrosplat

// Three numbers judge: a difference that makes a pixel bad, how many bad pixels there may be, and a
// difference that none may exceed. Rounding of edges is what they leave room for.
#include "gui/reference_screens.h"

#include <OpenImageIO/imageio.h>

#include "support/test.h"

namespace astrosplat {
namespace {

constexpr int bad_difference = 6, most_bad = 8, most_difference = 24;  // of 255; pixels; of 255

std::optional<Picture8> read_reference(const fs::path& file) {
    const auto in = OIIO::ImageInput::open(file.string());
    if (!in) return std::nullopt;
    Picture8 picture(in->spec().width, in->spec().height);
    std::vector<std::uint8_t> rgb(picture.pixels.size() * 3);
    if (in->spec().nchannels != 3 || !in->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, rgb.data()))
        return std::nullopt;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], 255};
    return picture;
}

void write_png(const fs::path& file, const Picture8& picture) {
    fs::create_directories(file.parent_path());
    std::vector<std::uint8_t> rgb;
    for (const Rgba8& p : picture.pixels) rgb.insert(rgb.end(), {p.r, p.g, p.b});
    OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("png:compressionLevel", 9);
    const auto out = OIIO::ImageOutput::create(file.string());
    const bool written =
        out && out->open(file.string(), spec) && out->write_image(spec.format, rgb.data()) && out->close();
    EXPECT_TRUE(written) << file;
}

int difference(const Rgba8& a, const Rgba8& b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

/// How two pictures of one size differ.
struct Differences {
    Picture8 seen;  // four times as bright
    int bad = 0, most = 0, first = -1;
    bool few() const { return bad <= most_bad && most <= most_difference; }
};

Differences differences(const Picture8& a, const Picture8& b) {
    Differences found{Picture8(a.width, a.height)};
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const int d = difference(a.pixels[i], b.pixels[i]);
        const auto shown = std::uint8_t(std::min(255, 4 * d));
        found.seen.pixels[i] = {shown, shown, shown, 255};
        found.most = std::max(found.most, d);
        if (d > bad_difference && found.bad++ == 0) found.first = int(i);
    }
    return found;
}

Picture8 draw(float tremble_px) {
    const ImDrawData& data = *ImGui::GetDrawData();
    Picture8 picture(int(data.DisplaySize.x), int(data.DisplaySize.y));
    software_draw(data, picture, Style::schematic, tremble_px);
    return picture;
}

void expect_few(const Differences& found, const std::string& name, const std::string& what,
                const Picture8& drawn) {
    if (found.few()) return;
    const auto output = fs::path(ASTROSPLAT_BINARY_DIR) / "test-output" / "gui-references";
    write_png(output / (name + ".png"), drawn);
    write_png(output / (name + ".difference.png"), found.seen);
    ADD_FAILURE() << name << what << ": " << found.bad << " pixels differ, by up to " << found.most
                  << " of 255, the first at x " << found.first % drawn.width << ", y "
                  << found.first / drawn.width << "; see " << output;
}

}  // namespace

void expect_like_reference(const std::string& name, std::optional<Part> part) {
    constexpr float other_processor_px = 1.0f / 512;
    const auto output = fs::path(ASTROSPLAT_BINARY_DIR) / "test-output" / "gui-references";
    const auto file = fs::path(ASTROSPLAT_SOURCE_DIR) / "tests/gui/references" / (name + ".png");
    const Picture8 whole = draw(0.0f), drawn = part ? cropped(whole, *part) : whole;
    const Picture8 elsewhere = draw(other_processor_px);
    expect_few(differences(whole, elsewhere), name + ".elsewhere", " on another processor", elsewhere);
    for (const std::string& line : unsnapped_lines(*ImGui::GetDrawData()))
        ADD_FAILURE() << name << ": a line between pixels: " << line;
    const std::optional<Picture8> wanted = read_reference(file);
    if (wanted && wanted->width == drawn.width && wanted->height == drawn.height)
        return expect_few(differences(drawn, *wanted), name, "", drawn);
    write_png(output / (name + ".png"), drawn);
    ADD_FAILURE() << file << " is missing or of another size; see " << output / (name + ".png");
}

}  // namespace astrosplat

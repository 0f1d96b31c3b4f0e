// One item after the other; what is left over is refused.
#include "scene/frames.h"

#include <fmt/format.h>

#include <charconv>

#include "core/error.h"

namespace astrosplat {
namespace {

constexpr std::int64_t largest_frame = 999'999'999;
constexpr std::int64_t most_frames = 10'000'000;

/// Reads one item of a list and remembers how far it got.
class Reader {
  public:
    Reader(std::string_view item, const std::string& place) : rest_(item), item_(item), place_(place) {}

    std::int64_t number() {
        std::int64_t value = 0;
        const auto [end, problem] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
        if (problem == std::errc::result_out_of_range || value > largest_frame || value < -largest_frame)
            fail(fmt::format("frames between -{0} and {0}", largest_frame));
        if (problem != std::errc()) fail("frames such as 1-100,120,200-300x2");
        rest_.remove_prefix(std::size_t(end - rest_.data()));
        return value;
    }
    bool skip(std::string_view any) {
        if (rest_.empty() || any.find(rest_[0]) == std::string_view::npos) return false;
        rest_.remove_prefix(1);
        return true;
    }
    bool at_end() const { return rest_.empty(); }
    [[noreturn]] void fail(const std::string& expected) const {
        throw InputError(fmt::format("{}: expected {}, found '{}'", place_, expected, item_));
    }

  private:
    std::string_view rest_, item_;
    const std::string& place_;
};

void add_item(std::string_view item, const std::string& place, std::vector<std::int64_t>& frames) {
    Reader reader(item, place);
    const std::int64_t first = reader.number();
    const std::int64_t last = reader.skip("-") ? reader.number() : first;
    const std::int64_t step = reader.skip("xX:") ? reader.number() : 1;
    if (!reader.at_end()) reader.fail("frames such as 1-100,120,200-300x2");
    if (last < first) reader.fail("a range that ascends");
    if (step < 1) reader.fail("a step of at least 1");
    if ((last - first) / step + std::int64_t(frames.size()) >= most_frames)
        reader.fail(fmt::format("at most {} frames", most_frames));
    for (std::int64_t frame = first; frame <= last; frame += step) frames.push_back(frame);
}

}  // namespace

std::vector<std::int64_t> parse_frames(const std::string& text, const std::string& place) {
    std::string compact = text;
    std::erase_if(compact, [](char c) { return c == ' ' || c == '\t'; });
    std::vector<std::int64_t> frames;
    for (std::size_t begin = 0; begin <= compact.size();) {
        const std::size_t end = std::min(compact.find(',', begin), compact.size());
        add_item(std::string_view(compact).substr(begin, end - begin), place, frames);
        begin = end + 1;
    }
    std::ranges::sort(frames);
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    return frames;
}

std::string frames_text(const std::vector<std::int64_t>& frames) {
    std::string text;
    for (std::size_t begin = 0; begin < frames.size();) {
        std::size_t last = begin;
        const std::int64_t step = begin + 1 < frames.size() ? frames[begin + 1] - frames[begin] : 1;
        while (last + 1 < frames.size() && frames[last + 1] - frames[last] == step) ++last;
        if (step > 1 && last < begin + 2) last = begin;  // "1,3" is shorter than "1-3x2"
        if (!text.empty()) text += ',';
        text += fmt::format("{}", frames[begin]);
        if (last > begin) text += fmt::format("-{}", frames[last]);
        if (last > begin && step > 1) text += fmt::format("x{}", step);
        begin = last + 1;
    }
    return text;
}

}  // namespace astrosplat

// compare: how far two images are apart, in linear premultiplied light. verify: frames rendered again and
// compared with their files.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "batch_plan.h"
#include "command.h"
#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/text.h"
#include "device.h"
#include "estimate.h"
#include "exit.h"
#include "output/compare.h"
#include "output/metadata.h"
#include "output/write.h"
#include "pipeline.h"

namespace astrosplat {
namespace {

using Compression = OutputParams::Compression;

struct CompareOptions {
    fs::path b;
    std::optional<std::string> max_difference;  // exit_some_failed where a channel differs by more
};

int run_compare(const CommandOptions& options, const CompareOptions& own) {
    constexpr double any = std::numeric_limits<double>::infinity();
    const double limit =
        own.max_difference ? option_number("--max-difference", *own.max_difference, "a number >= 0", 0.0, any)
                           : any;
    const ImageComparison c = compare_files(options.input, own.b);
    Report report;
    report["identical"] = c.identical();
    report["max_difference"] = number(c.max_difference);
    report["max_at"] = {c.max_x, c.max_y};
    report["max_channel"] = std::string(1, "RGBA"[c.max_channel]);
    report["mean_difference"] = number(c.mean_difference);
    report["percentile_999"] = number(c.percentile_999);
    report["psnr_db"] = number(c.psnr_db);
    report["differing_pixels"] = c.differing_pixels;
    report["pixels"] = c.width * c.height;
    print_report(report, options.json);
    return c.max_difference > limit ? exit_some_failed : exit_done;
}

// verify: a frame's header says which frame, size, region and eye it is of. Where the scene gives the same
// frame hash, the frame is rendered and written beside it, and the two files are compared; so what rounding,
// views and compression do to both is the same.

struct Verdict {
    enum class Kind { equal, different, other_scene, damaged } kind = Kind::equal;
    std::string why;                  // of damage, and of differences that are not of pixels
    std::vector<KeyDifference> keys;  // first: the frame's, second: the scene's
    StoredComparison pixels;          // where they could be compared
};

Verdict damaged(const std::string& why) { return {Verdict::Kind::damaged, why, {}, {}}; }

/// State that frames of one size and region share.
struct VerifyJob {
    std::string resolution, region;
    BatchPlan plan;
    std::int64_t renderer_bytes = 0;     // limit; 0: none
    std::unique_ptr<Pipeline> pipeline;  // made for the first frame that is rendered
};

std::string region_text(const Region& r) {
    return r.width > 0 ? fmt::format("{},{},{},{}", r.x, r.y, r.width, r.height) : "";
}

bool fits(const Region& r, std::int64_t width, std::int64_t height) {
    return r.x >= 0 && r.y >= 0 && r.x <= width - r.width && r.y <= height - r.height;
}

/// Precision that was lost in the file is to be lost in its copy too.
void take_compression(OutputParams& output, bool dwaa) {
    if (dwaa)
        output.compression = Compression::dwaa;
    else if (output.compression == Compression::dwaa)
        output.compression = Compression::automatic;
}

class Verification {
  public:
    /// `count`: of the files that are asked for.
    Verification(const CommandOptions& options, std::int64_t count)
        : options_(options), count_(count), report_(options.progress) {}

    Verdict verdict(const fs::path& file, std::int64_t index) {
        const FrameHeader header = read_frame_header(file);
        if (!frame_is_whole(file)) return damaged("it cannot be read to its last pixel");
        if (!header.frame || header.frame_hash.empty() || header.pixel_hash.empty())
            return damaged("it does not say which frame of which scene it holds");
        if (!fits(header.region, header.whole_width, header.whole_height))
            return damaged("its region lies outside its frame");
        VerifyJob& job = job_for(header, file);
        const FrameScene now = frame_scene(job.plan.scene, static_cast<double>(*header.frame), header.eye);
        if (job.plan.hasher.frame_hash(now) != header.frame_hash)
            return {Verdict::Kind::other_scene, "", keys(header, job.plan.hasher.canonical_text(now)), {}};
        return compare(file, header, now, index);
    }

  private:
    static std::vector<KeyDifference> keys(const FrameHeader& header, const std::string& text) {
        if (header.hashed_text.empty()) return {};
        return differing_keys(header.hashed_text, text);
    }

    VerifyJob& job_for(const FrameHeader& header, const fs::path& file) {
        const std::string resolution = fmt::format("{}x{}", header.whole_width, header.whole_height);
        const std::string region = region_text(header.region);
        if (job_ && job_->resolution == resolution && job_->region == region) return *job_;
        job_.reset();  // before the next one takes memory
        CommandOptions batch = options_;
        batch.resolution = resolution;
        if (!region.empty()) batch.region = region;
        batch.output = file;
        job_ = std::make_unique<VerifyJob>(VerifyJob{resolution, region, plan_scene(batch), 0, {}});
        return *job_;
    }

    Verdict compare(const fs::path& file, const FrameHeader& header, const FrameScene& now,
                    std::int64_t index) {
        const fs::path copy = folder_.path() / ("frame" + file.extension().string());
        const std::string pixels = render(copy, header, now, index);
        Verdict verdict;
        verdict.pixels = compare_stored(file, copy);
        const bool same_hash = pixels == header.pixel_hash;
        using Result = StoredComparison::Result;
        if (verdict.pixels.result == Result::first_damaged) return damaged("it was changed meanwhile");
        if (!verdict.pixels.identical() || !same_hash) verdict.kind = Verdict::Kind::different;
        if (verdict.pixels.result == Result::other_form)
            verdict.why = verdict.pixels.other_form;
        else if (!same_hash)
            verdict.why = fmt::format("pixel hash {:.8} against {:.8}", header.pixel_hash, pixels);
        return verdict;
    }

    /// Into `copy`; returns the pixel hash.
    std::string render(const fs::path& copy, const FrameHeader& header, const FrameScene& now,
                       std::int64_t index) {
        BatchPlan& plan = job_->plan;
        if (!job_->pipeline) {
            const JobEstimate job = estimate(plan);
            job_->renderer_bytes = job.renderer_bytes;
            job_->pipeline = std::make_unique<Pipeline>(plan.scene, report_.begin_step("preparing"),
                                                        plan.cache, job.streamed);
            check_unchanged(plan.hasher.files(), stoppable());
        }
        Pipeline& pipeline = *job_->pipeline;
        const Progress progress = report_.begin_frame(*header.frame, index, count_);
        OutputParams output = now.scene.output;
        take_compression(output, header.dwaa);
        RenderSettings settings = render_settings(output);
        settings.region = plan.region;
        settings.memory_limit_bytes = job_->renderer_bytes;
        if (!device_) device_ = std::make_unique<FrameDevice>(options_);
        settings.device = device_->get();
        const RenderedFrame rendered = pipeline.frame(now, settings, progress);
        device_->check(rendered.statistics);
        progress.check();
        write_frame(
            {copy, output, settings.width, settings.height, settings.region, pipeline.layer_names(now)},
            rendered, {});
        return pixel_hash(rendered.beauty);
    }

    const CommandOptions& options_;
    std::int64_t count_;
    ProgressReport report_;
    std::unique_ptr<FrameDevice> device_;
    TemporaryFolder folder_;
    std::unique_ptr<VerifyJob> job_;
};

const char* word_of(Verdict::Kind kind) {
    constexpr std::array words = {"equal", "different", "made from another scene", "damaged"};
    return words[static_cast<std::size_t>(kind)];
}

bool has_pixels(const Verdict& verdict) {
    return verdict.kind == Verdict::Kind::different &&
           verdict.pixels.result == StoredComparison::Result::compared;
}

Report json_of(const fs::path& file, const Verdict& verdict) {
    Report report = {{"file", file.string()}, {"verdict", word_of(verdict.kind)}};
    if (!verdict.why.empty()) report["why"] = verdict.why;
    if (verdict.kind == Verdict::Kind::other_scene) {
        report["keys"] = Report::array();
        for (const KeyDifference& d : verdict.keys)
            report["keys"].push_back({{"key", d.key}, {"frame", d.first}, {"scene", d.second}});
    }
    if (has_pixels(verdict)) {
        const StoredComparison& c = verdict.pixels;
        report["differing_pixels"] = c.differing_pixels;
        report["pixels"] = c.pixels;
        report["max_difference"] = number(c.max_difference);
        report["max_at"] = {c.max_x, c.max_y};
        report["max_channel"] = c.max_channel;
        report["psnr_db"] = number(c.psnr_db);
    }
    return report;
}

/// A value in a line for people: files are hashes of their bytes.
std::string short_value(const std::string& value) {
    if (value.empty()) return "nothing";
    const bool is_hash = value.size() == 64 && value.find_first_not_of("0123456789abcdef") == value.npos;
    if (is_hash) return "a file " + value.substr(0, 8) + "...";
    return value.size() > 60 ? value.substr(0, 57) + "..." : value;
}

std::string told_keys(const std::vector<KeyDifference>& keys) {
    constexpr std::size_t most = 8;
    if (keys.empty()) return "the frame does not tell its keys";
    std::string text;
    for (std::size_t i = 0; i < std::min(most, keys.size()); ++i)
        text += fmt::format("{}{} is {} in the frame, {} in the scene", i ? "; " : "", keys[i].key,
                            short_value(keys[i].first), short_value(keys[i].second));
    if (keys.size() > most) text += fmt::format("; and {} more keys", keys.size() - most);
    return text;
}

std::string told_pixels(const StoredComparison& c) {
    if (c.differing_pixels == 0) return "what the file stores is the same";
    return fmt::format("{} of {} pixels, by at most {:.6g} in {} at {},{}, PSNR {:.1f} dB",
                       c.differing_pixels, c.pixels, c.max_difference, c.max_channel, c.max_x, c.max_y,
                       c.psnr_db);
}

std::string line_of(const Verdict& verdict) {
    std::string line = word_of(verdict.kind);
    if (verdict.kind == Verdict::Kind::other_scene) line += ": " + told_keys(verdict.keys);
    if (has_pixels(verdict)) line += ": " + told_pixels(verdict.pixels);
    if (!verdict.why.empty()) line += (has_pixels(verdict) ? ", " : ": ") + verdict.why;
    return line;
}

struct VerifyOptions {
    std::vector<fs::path> files;  // frames in any order, each of any size, region and eye
};

void print_verdicts(const std::vector<fs::path>& files, const std::vector<Verdict>& verdicts, bool json) {
    Report list = Report::array();
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
        if (json)
            list.push_back(json_of(files[i], verdicts[i]));
        else
            fmt::print("{}: {}\n", printable(files[i].string()), printable(line_of(verdicts[i])));
    }
    if (json) print_report(list, true);
}

/// exit_done when all are equal, else exit_some_failed.
int run_verify(const CommandOptions& options, const VerifyOptions& own) {
    for (const fs::path& file : own.files) require_readable(file);
    defer_interrupts();
    std::vector<Verdict> verdicts;
    try {
        Verification verification(options, std::ssize(own.files));
        for (const fs::path& file : own.files)
            verdicts.push_back(verification.verdict(file, std::ssize(verdicts) + 1));
    } catch (const Cancelled&) {
        print_verdicts(own.files, verdicts, options.json);  // each is true by itself
        throw;
    }
    print_verdicts(own.files, verdicts, options.json);
    const auto equal = [](const Verdict& verdict) { return verdict.kind == Verdict::Kind::equal; };
    return std::ranges::all_of(verdicts, equal) ? exit_done : exit_some_failed;
}

}  // namespace

void add_compare(CLI::App& app, Invocation& call) {
    auto [command, own] =
        add_command(app, call, "compare", "Compares the linear light of two images", run_compare);
    add_input(command, call.options, "A", "An image");
    add_value(command, "B", own.b, "B", "An image of the same size")->required();
    add_json(command, call.options);
    add_value(command, "--max-difference", own.max_difference, "X",
              "Largest difference allowed in any channel; beyond it the exit code is 3");
}

void add_verify(CLI::App& app, Invocation& call) {
    auto [command, own] =
        add_command(app, call, "verify", "Renders frames again and says whether files hold them", run_verify);
    add_input(command, call.options, "SCENE", "The scene");
    const auto set = [&files = own.files](const std::vector<std::string>& names) {
        files.assign(names.begin(), names.end());
    };
    command
        .add_option_function<std::vector<std::string>>(
            "FRAME", set, "Frame files; each says itself which frame, size, region and eye it holds")
        ->option_text("FRAME...")
        ->required();
    add_assignments(command, call.options);
    add_value(command, "--layers", call.options.layers, "A,B", "Where --batch had it too");
    add_value(command, "--memory", call.options.memory_gib, "GiB", "Where --batch had it too");
    add_json(command, call.options);
    add_device_option(command, call.options);
    add_progress(command, call.options);
}

}  // namespace astrosplat

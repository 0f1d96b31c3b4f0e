#include "viewer/farm_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/text.h"
#include "scene/frames.h"

namespace astrosplat {
namespace {

using Json = nlohmann::json;

void add_eye(const Json& eye, FarmReport& report) {
    report.frames += eye.at("frames").get<std::int64_t>();
    const Json& done = eye.at("done");
    const auto count = done.at("count").get<std::int64_t>();
    if (report.done == 0 && count > 0) report.done_frames = parse_frames(done.at("frames"), "status");
    report.done += count;
}

std::string queue_text(const Json& status) {
    const std::string problem = status.at("queue_problem");
    if (!problem.empty()) return ", queue unknown: " + problem;
    std::vector<std::string> parts;
    for (const Json& submission : status.at("queue")) {
        if (!submission.at("active")) continue;
        const std::string sets = submission.at("sets");
        if (!sets.empty() && sets != "COMPLETED") parts.push_back("the sets " + lower_case(sets));
        for (const auto& [state, count] : submission.at("tasks").items())
            parts.push_back(fmt::format("{} {}", count.get<std::int64_t>(), lower_case(state)));
    }
    return parts.empty() ? "" : fmt::format(", in the queue: {}", fmt::join(parts, ", "));
}

}  // namespace

std::optional<FarmReport> read_farm_report(const std::string& output) try {
    const std::size_t begin = output.rfind("{", 0) == 0 ? 0 : output.find("\n{");
    const std::size_t end = output.rfind('}');
    if (begin == std::string::npos || end == std::string::npos || end < begin) return std::nullopt;
    const Json status = Json::parse(output.substr(begin, end + 1 - begin));
    FarmReport report;
    report.complete = status.at("complete");
    report.active = !status.at("queue_problem").get<std::string>().empty();
    for (const Json& eye : status.at("eyes")) add_eye(eye, report);
    for (const Json& submission : status.at("queue")) {
        if (!submission.at("active")) continue;
        report.active = true;
        for (const char* job : {"sets_job", "frames_job"}) report.jobs.push_back(submission.at(job));
    }
    report.text = fmt::format("{} of {} done{}", report.done, report.frames, queue_text(status));
    return report;
} catch (const Json::exception&) {
    return std::nullopt;
} catch (const InputError&) {  // of the list of frames
    return std::nullopt;
}

std::vector<std::int64_t> submitted_jobs(const std::string& output) {
    constexpr std::string_view before[] = {" submitted as job ", ", which waits for the sets of job "};
    std::vector<std::int64_t> jobs;
    std::size_t at = 0;
    for (const std::string_view words : before) {
        at = output.find(words, at);
        if (at == std::string::npos) return {};
        at += words.size();
        std::int64_t job = 0;
        if (std::from_chars(output.data() + at, output.data() + output.size(), job).ec != std::errc{})
            return {};
        jobs.push_back(job);
    }
    return jobs;
}

}  // namespace astrosplat

// --log-json: what stands on stderr can be read line by line by a program.
#include <nlohmann/json.hpp>
#include <sstream>

#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

using Event = nlohmann::json;

class LogJson : public SceneTest {
  protected:
    static std::vector<Event> events(const std::string& err) {
        std::vector<Event> events;
        std::istringstream lines(err);
        for (std::string line; std::getline(lines, line);) {
            events.push_back(Event::parse(line, nullptr, false));
            EXPECT_TRUE(events.back().is_object()) << line;
        }
        return events;
    }
    static std::vector<Event> of_kind(const std::vector<Event>& events, const std::string& kind) {
        std::vector<Event> found;
        for (const Event& event : events)
            if (event.at("event") == kind) found.push_back(event);
        return found;
    }
};

TEST_F(LogJson, ARunIsToldEventByEvent) {
    const RunResult result = batch({"--log-json", "-o", "a \"b\"/é.##.exr"});
    EXPECT_EQ(result.code, 0) << result.err;
    const std::vector<Event> all = events(result.err);
    for (const Event& event : all) EXPECT_EQ(event.at("time").get<std::string>().size(), 24u) << event;
    EXPECT_FALSE(of_kind(all, "message").empty());
    const std::vector<Event> saved = of_kind(all, "saved");
    ASSERT_EQ(saved.size(), 3u);
    EXPECT_EQ(fs::path(saved[1].at("file").get<std::string>()).filename(), "é.02.exr");
    EXPECT_GE(saved[1].at("seconds").get<double>(), 0.0);
    std::vector<Event> second;
    for (const Event& event : of_kind(all, "progress"))
        if (event.contains("frame") && event.at("frame") == 2) second.push_back(event);
    ASSERT_FALSE(second.empty());
    EXPECT_EQ(second[0].at("index"), 2);
    EXPECT_EQ(second[0].at("count"), 3);
    EXPECT_EQ(second[0].at("fraction"), 0.0);
    EXPECT_NEAR(second[0].at("fraction_of_all").get<double>(), 1.0 / 3.0, 1e-9);
    EXPECT_GE(second[0].at("seconds_left_of_all").get<double>(), 0.0);
    EXPECT_FALSE(second[0].contains("seconds_left")) << "nothing of it is done yet";
}

TEST_F(LogJson, MistakesAreEvents) {
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--batch", "no such.toml"},
                                                  {"--no-such-option"},
                                                  {"info", "no such.toml"}}) {
        std::vector<std::string> words{"--log-json"};
        words.insert(words.end(), wrong.begin(), wrong.end());
        if (wrong[0] == "info") std::swap(words[0], words[1]);
        const RunResult result = run(words);
        EXPECT_EQ(result.code, 2) << result.err;
        const std::vector<Event> all = events(result.err);
        ASSERT_EQ(all.size(), 1u) << result.err;
        EXPECT_EQ(all[0].at("event"), "message");
        EXPECT_EQ(all[0].at("level"), "error");
        EXPECT_NE(all[0].at("text").get<std::string>().find("no"), std::string::npos);
    }
}

TEST_F(LogJson, WithoutItNothingIsJson) {
    const RunResult result = batch();
    EXPECT_EQ(result.err.find('{'), std::string::npos) << result.err;
}

TEST_F(LogJson, QuietLeavesErrors) { EXPECT_EQ(batch({"--log-json", "-q"}).err, ""); }

}  // namespace
}  // namespace astrosplat::test

// WCSLIB's structures are not to be shared by threads: each row of places works on a copy.
#include "source/sky_grid.h"

#include <erfa.h>
#include <fmt/format.h>
#include <wcs.h>
#include <wcsfix.h>
#include <wcshdr.h>
#include <wcsmath.h>

#include <mutex>

#include "core/log.h"
#include "core/real.h"
#include "core/text.h"

#undef undefined  // a macro of wcsmath.h, and a name in files compiled behind this one

namespace astrosplat {
namespace {

constexpr std::size_t card_length = 80;
constexpr double most_degrees = 1e4;  // no header that means something goes around more often
constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();

struct FreeWcs {
    void operator()(wcsprm* wcs) const {
        wcsfree(wcs);
        delete wcs;
    }
};
using Wcs = std::unique_ptr<wcsprm, FreeWcs>;

Wcs new_wcs() {
    Wcs wcs(new wcsprm{});
    wcs->flag = -1;
    return wcs;
}

/// Ready to be used by one thread.
Wcs copied(const wcsprm& from) {
    Wcs wcs = new_wcs();
    if (wcssub(1, &from, nullptr, nullptr, wcs.get()) != 0 || wcsset(wcs.get()) != 0) throw std::bad_alloc();
    return wcs;
}

/// Its celestial axes, ready; the reason in `problem` where they are not followed, with their `type` where
/// WCSLIB refuses them. Null and no problem: none.
Wcs celestial_axes(wcsprm& all, const std::string& type, std::string& problem) {
    std::array<int, NWCSFIX> fixed{};
    wcsfix(0, nullptr, &all, fixed.data());
    int axes[] = {WCSSUB_CELESTIAL}, count = 1;
    Wcs wcs = new_wcs();
    const auto reason = [&](const wcsprm& failed, int status) {
        const std::string text = failed.err ? failed.err->msg : wcs_errmsg[status];
        return fmt::format("{} ({})", type, text.substr(0, text.find('\n')));
    };
    // That has called wcsset, which, called once more after a failure, loses the first one's messages (7.12).
    const int status_of_all = fixed[CELFIX] > 0 ? fixed[CELFIX] : wcsset(&all);
    if (status_of_all != 0) {
        problem = reason(all, status_of_all);
        return {};
    }
    if (all.lng < 0 || all.lat < 0) return {};
    for (const int axis : {all.lng, all.lat})
        if (!(std::fabs(all.crval[axis]) <= most_degrees))
            problem = fmt::format("a reference at {} degrees", all.crval[axis]);
    if (!problem.empty()) return {};
    int status = wcssub(1, &all, &count, axes, wcs.get());
    if (status == 0) status = wcsset(wcs.get());
    if (status != 0 || wcs->naxis != 2) problem = reason(*wcs, status);
    return wcs;
}

struct Card {
    std::string text;  // 80 characters
    std::string_view keyword() const { return trim(std::string_view(text).substr(0, 8)); }
    bool is(std::string_view name) const { return keyword().starts_with(name); }
    bool says(std::string_view value) const { return text.find(value, 9) != std::string::npos; }
    bool is_zero() const {
        return text.find_first_of("123456789", 9) >= std::min(text.find('/'), text.size());
    }
    /// Of PVi_m.
    int parameter() const {
        const std::string_view name = keyword();
        const std::optional<std::int64_t> m =
            parse_int64(name.substr(std::min(name.find('_'), name.size() - 1) + 1));
        return is("PV") && m ? int(std::clamp<std::int64_t>(*m, 0, 99)) : 0;
    }
    void to_capitals() {
        for (std::size_t i = 9; i < std::min(text.find('/'), text.size()); ++i)
            text[i] = char(std::toupper(static_cast<unsigned char>(text[i])));
    }
};

/// What WCSLIB follows; nothing without the size of a pixel, for which the standard has 1 degree. Names of
/// axes are in capitals; SCAMP's polynomials, which are older than the name TPV, under that name, but not
/// beside SIP's, which say the same (Shupe et al. 2012, SPIE 8451, section 7); no tables of distortions.
std::string plain_cards(const fs::path& file, const std::string& all) {
    std::vector<Card> cards;
    for (std::size_t at = 0; at + card_length <= all.size(); at += card_length)
        cards.push_back({all.substr(at, card_length)});
    const auto any = [&](const auto& wanted) { return std::ranges::any_of(cards, wanted); };
    // WCSLIB takes a matrix of zeros for none.
    if (!any([](const Card& card) { return (card.is("CD") || card.is("PC")) && !card.is_zero(); })) return {};
    for (Card& card : cards)
        if (card.is("CTYPE") || card.is("CPDIS") || card.is("CQDIS")) card.to_capitals();
    const bool sip = any([](const Card& card) { return card.is("CTYPE") && card.says("-SIP"); });
    const bool scamp = any([](const Card& card) { return card.parameter() >= 5; }) &&
                       any([](const Card& card) { return card.is("CTYPE") && card.says("-TAN"); });
    if (scamp && sip) std::erase_if(cards, [](const Card& card) { return card.is("PV"); });
    if (scamp && !sip)
        for (Card& card : cards)
            if (const std::size_t at = card.text.find("-TAN"); card.is("CTYPE") && at != std::string::npos)
                card.text.replace(at, 4, "-TPV");
    const auto is_table = [](const Card& card) {
        return card.is("D2IMDIS") || ((card.is("CPDIS") || card.is("CQDIS")) && card.says("'LOOKUP"));
    };
    if (any(is_table)) {
        // Each axis has its table, and records about it: DP1.EXTVER, or DP1 = 'EXTVER: 1'.
        std::erase_if(cards,
                      [&](const Card& card) { return is_table(card) || card.is("DP") || card.is("DQ"); });
        log_warning(fmt::format(
            "{}: its table of distortions (CPDIS, D2IM) is not followed; what the sky shows may lie "
            "a part of a pixel off",
            file.string()));
    }
    std::string plain;
    for (const Card& card : cards) plain += card.text;
    return plain;
}

/// Of cards of which WCSLIB makes no sky: "the projection RA---TAB", where they mean one; or nothing.
std::string celestial_type(const std::string& cards) {
    for (std::size_t at = 0; at + card_length <= cards.size(); at += card_length) {
        const Card card{cards.substr(at, card_length)};
        if (!card.is("CTYPE") || !(card.says("'RA--") || card.says("LON-"))) continue;
        const std::size_t begin = card.text.find('\'') + 1;
        return "the projection " + card.text.substr(begin, card.text.find_first_of("' ", begin) - begin);
    }
    return {};
}

constexpr double j2000 = 2451545.0, julian_year = 365.25;

/// A direction between its own frame and ICRS, which FK5 of J2000 is to 0.03 arc seconds.
struct Turn {
    SkyFrame frame;
    double precession[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // from J2000

    Turn(SkyFrame own, double equinox) : frame(own) {
        if (own == SkyFrame::fk5 && equinox != 2000.0)
            eraPmat76(j2000 + julian_year * (equinox - 2000.0), 0.0, precession);
    }

    void to_icrs(double& a, double& b) {
        if (frame == SkyFrame::fk4) eraFk45z(a, b, 1950.0, &a, &b);
        if (frame == SkyFrame::galactic) eraG2icrs(a, b, &a, &b);
        if (frame == SkyFrame::ecliptic) eraEceq06(j2000, 0.0, a, b, &a, &b);
        if (frame == SkyFrame::fk5) turn(eraTrxp, a, b);
    }

    void from_icrs(double& a, double& b) {
        double proper_motion[2];
        if (frame == SkyFrame::fk4) eraFk54z(a, b, 1950.0, &a, &b, &proper_motion[0], &proper_motion[1]);
        if (frame == SkyFrame::galactic) eraIcrs2g(a, b, &a, &b);
        if (frame == SkyFrame::ecliptic) eraEqec06(j2000, 0.0, a, b, &a, &b);
        if (frame == SkyFrame::fk5) turn(eraRxp, a, b);
    }

  private:
    void turn(void (*by)(double[3][3], double[3], double[3]), double& a, double& b) {
        double from[3], to[3];
        eraS2c(a, b, from);
        by(precession, from, to);
        eraC2s(to, &a, &b);
    }
};

/// FITS 4.0, table 24: without RADESYS the equinox tells. What is not followed in `problem`.
SkyFrame frame_of(const wcsprm& wcs, double& equinox, std::string& problem) {
    const std::string type(trim(wcs.lngtyp)), system(trim(wcs.radesys));
    if (type == "GLON") return SkyFrame::galactic;
    if (type == "ELON") return SkyFrame::ecliptic;
    if (type != "RA") {
        problem = fmt::format("the frame {}", trim(wcs.ctype[wcs.lng]));
        return SkyFrame::icrs;
    }
    const bool known = wcs.equinox != UNDEFINED;
    const bool fk4 = system.empty() ? known && wcs.equinox < 1984.0 : system == "FK4";
    const bool fk5 = system.empty() ? known && !fk4 : system == "FK5";
    equinox = known ? wcs.equinox : fk4 ? 1950.0 : 2000.0;
    if (!fk4 && !fk5 && !system.empty() && system != "ICRS") problem = "the frame " + system;
    if (fk4 && equinox != 1950.0) problem = fmt::format("the frame FK4 of {}", equinox);
    return fk4 ? SkyFrame::fk4 : fk5 ? SkyFrame::fk5 : SkyFrame::icrs;
}

}  // namespace

FitsSky read_fits_sky(const fs::path& file, std::string cards, std::int64_t height, bool top_down) {
    FitsSky sky;
    cards = plain_cards(file, cards);
    static std::mutex mutex;  // of WCSLIB's parsers
    const std::lock_guard lock(mutex);
    wcserr_enable(1);
    struct Parsed {
        int rejected = 0, count = 0;
        wcsprm* wcs = nullptr;
        ~Parsed() { wcsvfree(&count, &wcs); }
    } parsed;
    const int status = wcspih(cards.data(), int(cards.size() / card_length), WCSHDR_all, 0, &parsed.rejected,
                              &parsed.count, &parsed.wcs);
    Wcs wcs;
    if (status == 0 && parsed.count > 0)
        wcs = celestial_axes(parsed.wcs[0], celestial_type(cards), sky.unfollowed);
    if (!wcs && sky.unfollowed.empty()) sky.unfollowed = celestial_type(cards);
    if (!wcs || !sky.unfollowed.empty()) return sky;
    auto grid = std::make_shared<SkyGrid>();
    grid->frame_ = frame_of(*wcs, grid->equinox_, sky.unfollowed);
    const auto degrees = [&](int axis, int pixels) {
        return wcs->lin.cdelt[axis] * wcs->lin.pc[2 * axis + pixels] * (top_down && pixels == 1 ? -1.0 : 1.0);
    };
    grid->cd_ = {degrees(wcs->lng, 0), degrees(wcs->lng, 1), degrees(wcs->lat, 0), degrees(wcs->lat, 1)};
    const auto& [east_right, east_up, north_right, north_up] = grid->cd_;
    if (!(std::fabs(east_right * north_up - east_up * north_right) > 0.0))
        sky.unfollowed = "pixels without an area";
    if (!sky.unfollowed.empty()) return sky;
    grid->flip_ = top_down ? double(height) + 1.0 : 0.0;
    grid->wcs_ = std::move(wcs);
    double a = real::radians(grid->wcs_->crval[grid->wcs_->lng]),
           b = real::radians(grid->wcs_->crval[grid->wcs_->lat]);
    Turn(grid->frame_, grid->equinox_).to_icrs(a, b);
    grid->reference_ = {real::degrees(eraAnp(a)), real::degrees(b)};
    sky.grid = std::move(grid);
    return sky;
}

bool SkyGrid::operator==(const SkyGrid& other) const {
    int same = 0;
    const Wcs a = copied(*wcs_), b = copied(*other.wcs_);
    return wcscompare(WCSCOMPARE_ANCILLARY, 0.0, a.get(), b.get(), &same) == 0 && same != 0 &&
           frame_ == other.frame_ && equinox_ == other.equinox_ && flip_ == other.flip_;
}

void SkyGrid::to_sky(std::span<glm::dvec2> places) const {
    const Wcs wcs = copied(*wcs_);
    if (flip_ != 0.0)
        for (glm::dvec2& place : places) place.y = flip_ - place.y;
    const std::size_t n = places.size();
    std::vector<double> image(2 * n), phi(n), theta(n), world(2 * n);
    std::vector<int> failed(n);
    wcsp2s(wcs.get(), int(n), 2, &places[0].x, image.data(), phi.data(), theta.data(), world.data(),
           failed.data());
    Turn turn(frame_, equinox_);
    for (std::size_t i = 0; i < n; ++i) {
        double a = real::radians(world[2 * i + wcs->lng]), b = real::radians(world[2 * i + wcs->lat]);
        turn.to_icrs(a, b);
        places[i] = failed[i] ? glm::dvec2(nowhere) : glm::dvec2(real::degrees(eraAnp(a)), real::degrees(b));
    }
}

void SkyGrid::to_pixels(std::span<glm::dvec2> places) const {
    const Wcs wcs = copied(*wcs_);
    const std::size_t n = places.size();
    std::vector<double> image(2 * n), phi(n), theta(n), world(2 * n), pixels(2 * n);
    std::vector<int> failed(n);
    Turn turn(frame_, equinox_);
    for (std::size_t i = 0; i < n; ++i) {
        const bool known = std::isfinite(places[i].x);
        double a = known ? real::radians(places[i].x) : 0.0, b = known ? real::radians(places[i].y) : 0.0;
        turn.from_icrs(a, b);
        world[2 * i + wcs->lng] = real::degrees(eraAnp(a));
        world[2 * i + wcs->lat] = real::degrees(b);
    }
    wcss2p(wcs.get(), int(n), 2, world.data(), phi.data(), theta.data(), image.data(), pixels.data(),
           failed.data());
    const auto snapped = [](double px) { return std::floor(px * 4096.0 + 0.5) / 4096.0; };
    for (std::size_t i = 0; i < n; ++i) {
        if (failed[i]) places[i] = glm::dvec2(nowhere);
        if (std::isnan(places[i].x)) continue;
        const double y = pixels[2 * i + 1];
        places[i] = {snapped(pixels[2 * i]), snapped(flip_ != 0.0 ? flip_ - y : y)};
    }
}

}  // namespace astrosplat

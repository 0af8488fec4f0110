// Line segments sorted into horizontal bands, so that a question looks at those near its point only.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec2.hpp"

namespace pogosim {

/// Points above or below the bounds are kept in the first or last band, so that every search also finds them.
class BandIndex {
public:
    /// Bands for about `segment_count` segments.
    BandIndex(Box bounds_mm, std::size_t segment_count)
        : top_(bounds_mm.min.y), height_(bounds_mm.size().y), bands_(std::min(segment_count, kMostBands)) {}

    /// Adds segment `index`, which lies between these heights.
    void add(std::uint32_t index, float top, float bottom) {
        for (std::size_t band = band_of(top); band <= band_of(bottom); ++band) {
            bands_[band].push_back(index);
        }
    }

    /// Segments that meet this height, and some more.
    std::span<std::uint32_t const> at(float y) const {
        return bands_.empty() ? std::span<std::uint32_t const>{} : bands_[band_of(y)];
    }

    /// Calls visit(index) for every segment that comes between these heights, and some more; for some repeatedly.
    template <typename Visit>
    void for_each_between(float top, float bottom, Visit visit) const {
        if (bands_.empty()) {
            return;
        }
        for (std::size_t band = band_of(top); band <= band_of(bottom); ++band) {
            std::ranges::for_each(bands_[band], visit);
        }
    }

private:
    static constexpr std::size_t kMostBands = 128;

    std::size_t band_of(float y) const {
        float const fraction = (y - top_) / height_;
        float const band = fraction * static_cast<float>(bands_.size());
        return static_cast<std::size_t>(std::clamp(band, 0.0F, static_cast<float>(bands_.size() - 1)));
    }

    float top_;
    float height_;
    std::vector<std::vector<std::uint32_t>> bands_;  // segments that meet each band, from the top
};

}  // namespace pogosim

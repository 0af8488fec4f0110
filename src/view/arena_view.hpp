// Which part of the arena the window shows: all of it, until the user moves the view or zooms.
#pragma once

#include "render/camera.hpp"

namespace pogosim {

class ArenaView {
public:
    ArenaView(Box const& bounds_mm, PictureSize size) : bounds_mm_(bounds_mm), size_(size) { show_all(); }

    Camera const& camera() const { return camera_; }
    bool shows_all() const { return camera_ == fitted(bounds_mm_, size_); }
    Vec2 to_mm(Vec2 point_px) const { return camera_.to_mm(point_px, size_); }
    Vec2 middle_px() const { return size_.middle_px(); }

    void show(Camera const& camera) { camera_ = camera; }
    void show_all() { camera_ = fitted(bounds_mm_, size_); }
    void centre_on(Vec2 point_mm) { camera_.centre_mm = point_mm; }
    void pan(Vec2 motion_px) { centre_on(camera_.centre_mm + (1.0F / camera_.scale_px_mm) * motion_px); }

    /// The point under `fixed_px` stays where it is.
    void zoom(float factor, Vec2 fixed_px) {
        camera_ = zoomed(camera_, factor, fixed_px, size_, zoom_limits(bounds_mm_, size_));
    }

    /// The arena stays in the middle; when all of it was shown, all of it is.
    void resize(PictureSize size) {
        bool const is_fitted = shows_all();
        size_ = size;
        if (is_fitted) {
            show_all();
        }
    }

private:
    Box bounds_mm_;
    PictureSize size_;
    Camera camera_;
};

}  // namespace pogosim

// The window: shows the latest moment of a run, and turns keys and the mouse into commands.
#include <SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csetjmp>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "view/actions.hpp"
#include "view/arena_view.hpp"
#include "view/column_history.hpp"
#include "view/module.hpp"
#include "view/panels.hpp"
#include "view/pointer.hpp"
#include "view/run_requests.hpp"
#include "view/screenshot.hpp"
#include "view/sdl_window.hpp"
#include "view/shown_moment.hpp"
#include "view/switches.hpp"

namespace pogosim {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kPicturePeriod = std::chrono::microseconds(16667);  // 60 per second
constexpr auto kQuietPeriod = std::chrono::milliseconds(100);      // between looks at a run in which nothing happens
constexpr auto kMessageTime = std::chrono::seconds(2);
constexpr auto kReadingTime = std::chrono::milliseconds(50);  // for each byte of a message
constexpr int kPicturesAfterInput = 20;                       // the run answers, and panels settle
constexpr float kPickMarginPx = 6.0F;
constexpr float kPanStepPx = 40.0F;
constexpr float kZoomStep = 1.1F;
constexpr float kPinchZoom = 4.0F;  // for fingers that part by the width of the window
constexpr double kSlower = 0.8;
constexpr double kFaster = 1.2;

class Window {
public:
    Window(WindowSetup const& setup, Exchange& exchange)
        : setup_(setup),
          exchange_(exchange),
          window_(setup),
          panels_(window_.text_scale()),
          canvas_(window_.size()),
          history_(setup.columns.size(), setup.scenery->robot_id.size()),
          options_(setup.restored ? setup.restored->options : setup.options),
          view_(setup.scenery->arena.bounds, canvas_.size()),
          requests_(exchange, {.paused = setup.restored && setup.restored->paused, .asked_speed_up = setup.speed_up}),
          moment_(options_.history_s) {
        state_.setup = &setup_;
        state_.history = &history_;
        state_.options = &options_;
        state_.status = &requests_.status();
        state_.control = setup.restored ? setup.restored->panels : setup.panels;
        if (setup.restored) {
            state_.plot = setup.restored->plot;
            state_.column = std::min(setup.restored->column, std::max<std::size_t>(setup.columns.size(), 1) - 1);
            state_.column_is_chosen = state_.plot;
        }
        if (options_.selected_robot.value_or(0) >= setup.scenery->robot_id.size()) {
            options_.selected_robot.reset();
        }
        state_.condition = options_.pause_when;
        if (setup.restored && setup.restored->camera) {
            view_.show(*setup.restored->camera);
        } else {
            view_.zoom(static_cast<float>(options_.zoom), view_.middle_px());
        }
    }

    /// Until the user or the simulation closes it.
    void run() {
        auto next_picture = Clock::now();
        ask();
        while (!closed_ && !exchange_.is_closing()) {
            wait_for_events(next_picture);
            take_moment();
            auto const now = Clock::now();
            if (now < next_picture) {
                continue;
            }
            next_picture = std::max(next_picture + kPicturePeriod, now);
            state_.seconds_since_moment = std::chrono::duration<double>(now - last_moment_).count();
            bool const is_waiting = state_.seconds_since_moment > kBusyS && now - last_drawn_ > kQuietPeriod;
            bool const must_draw = is_stale_ || pictures_to_draw_ > 0 || message_is_over(now) || is_waiting;
            if (window_.is_visible() && must_draw) {
                ask();  // the simulation answers while this one is being drawn
                draw(now);
            } else if (now - last_asked_ > kQuietPeriod) {
                ask();
            }
        }
    }

private:
    void wait_for_events(Clock::time_point until) {
        auto const left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now());
        SDL_Event event;
        if (SDL_WaitEventTimeout(&event, static_cast<int>(std::clamp<long long>(left.count(), 1, 16))) == 0) {
            return;
        }
        do {
            take(event);
        } while (SDL_PollEvent(&event) != 0);
    }

    void take(SDL_Event const& event) {
        pictures_to_draw_ = kPicturesAfterInput;
        switch (event.type) {
            case SDL_QUIT:
                quit();
                break;
            case SDL_TEXTINPUT:
                typed_.text += event.text.text;
                break;
            case SDL_KEYDOWN:
                if (panels_.wants_text()) {
                    take_typing(event.key.keysym);
                } else if (state_.question) {
                    answer(event.key.keysym.sym);
                } else if (Switch const* const one = switch_of(event.key.keysym.sym)) {
                    if (event.key.repeat == 0) {  // held down, it would flicker
                        one->press(options_);
                    }
                } else if (auto const action = action_of(event.key.keysym.sym, (event.key.keysym.mod & KMOD_SHIFT) != 0,
                                                         event.key.repeat != 0)) {
                    carry_out(*action);
                }
                break;
            case SDL_MOUSEWHEEL:
                take_wheel(event.wheel);
                break;
            case SDL_MOUSEBUTTONDOWN:
                take_press(event.button);
                break;
            case SDL_MOUSEBUTTONUP:
                take_release(event.button);
                break;
            case SDL_MOUSEMOTION:
                take_motion(window_.to_pixels(event.motion.x, event.motion.y));
                break;
            case SDL_MULTIGESTURE:
                take_pinch(event.mgesture);
                break;
            case SDL_WINDOWEVENT:
                take_window_event(event.window);
                break;
            default:
                break;
        }
    }

    /// A key while the user types into a field; letters come as SDL_TEXTINPUT.
    void take_typing(SDL_Keysym const& key) {
        typed_.keys.push_back(key.sym == SDLK_KP_ENTER ? SDLK_RETURN : key.sym);
        typed_.ctrl = typed_.ctrl || (key.mod & (KMOD_CTRL | KMOD_GUI)) != 0;
        typed_.shift = typed_.shift || (key.mod & KMOD_SHIFT) != 0;
    }

    void take_window_event(SDL_WindowEvent const& event) {
        if (event.event == SDL_WINDOWEVENT_SIZE_CHANGED) {
            resize();
        } else if (event.event == SDL_WINDOWEVENT_FOCUS_LOST || event.event == SDL_WINDOWEVENT_LEAVE) {
            // The button may be released outside the window.
            if ((SDL_GetGlobalMouseState(nullptr, nullptr) & SDL_BUTTON_LMASK) == 0) {
                drop();
            }
        }
    }

    void carry_out(Action action) {
        switch (action) {
            case Action::help:
                show_help();
                break;
            case Action::slower:
                requests_.change_speed(kSlower);
                break;
            case Action::faster:
                requests_.change_speed(kFaster);
                break;
            case Action::panels:
                state_.control = !state_.control;
                break;
            case Action::full_screen:
                window_.toggle_full_screen();
                break;
            case Action::screenshot:
                say(save_screenshot(canvas_));
                break;
            case Action::follow:
                follow();
                break;
            case Action::look_back:
                look_at_neighbour(-1);
                break;
            case Action::look_forward:
                look_at_neighbour(1);
                break;
            case Action::look_at_newest:
                moment_.look_at_newest();
                break;
            case Action::quit:
                quit();
                break;
            case Action::pause:
                send(Pause{!requests_.status().paused});
                break;
            case Action::step:
                send(StepOnce{});
                break;
            case Action::restart:
                restart(setup_.seed);
                break;
            case Action::restart_with_next_seed:
                restart(setup_.seed + 1);
                break;
            case Action::pan_left:
                pan({-kPanStepPx, 0.0F});
                break;
            case Action::pan_right:
                pan({kPanStepPx, 0.0F});
                break;
            case Action::pan_up:
                pan({0.0F, -kPanStepPx});
                break;
            case Action::pan_down:
                pan({0.0F, kPanStepPx});
                break;
            case Action::zoom_in:
                view_.zoom(kZoomStep, view_.middle_px());
                break;
            case Action::zoom_out:
                view_.zoom(1.0F / kZoomStep, view_.middle_px());
                break;
            case Action::reset_view:
                reset_view();
                break;
        }
    }

    void send(Command const& command) {
        if (auto const* const again = std::get_if<Restart>(&command)) {
            restart(again->seed);
            return;
        }
        if (std::holds_alternative<Quit>(command)) {
            quit();
            return;
        }
        if (std::string const problem = requests_.send(command); !problem.empty()) {
            say(problem);
            return;
        }
        auto const* const pause = std::get_if<Pause>(&command);
        if ((pause != nullptr && !pause->on) || std::holds_alternative<StepOnce>(command)) {
            moment_.look_at_newest();
        } else if (auto const* const condition = std::get_if<PauseWhen>(&command)) {
            options_.pause_when = condition->condition;
        }
    }

    void look_at(double time_s) { pause_for_the_past(moment_.look_at(time_s)); }
    void look_at_neighbour(int direction) { pause_for_the_past(moment_.look_at_neighbour(direction)); }

    /// A run pauses when the user looks at its past.
    void pause_for_the_past(bool is_past) {
        if (is_past && !requests_.status().paused && !requests_.status().is_over) {
            send(Pause{true});
        }
    }

    /// Keeps the selected robot in the middle, or no longer.
    void follow() {
        if (options_.follow) {
            options_.follow.reset();
        } else if (options_.selected_robot) {
            options_.follow = setup_.scenery->robot_id[*options_.selected_robot];
        } else {
            say("select the robot to follow: click it");
        }
    }

    void restart(std::uint32_t seed) {
        RestartCheck const check = setup_.check_restart();
        if (!check.problem.empty()) {
            say("cannot restart: " + check.problem);
        } else if (check.overwritten.empty()) {
            restart(seed, /*overwrite=*/false);
        } else {
            state_.question = RestartQuestion{seed, check.overwritten};
        }
    }

    /// By a key.
    void answer(SDL_Keycode key) {
        switch (key) {
            case SDLK_k:
            case SDLK_RETURN:
            case SDLK_KP_ENTER:
                answer(RestartAnswer::keep);
                break;
            case SDLK_o:
                answer(RestartAnswer::overwrite);
                break;
            case SDLK_c:
            case SDLK_ESCAPE:
                answer(RestartAnswer::cancel);
                break;
            default:
                break;
        }
    }

    void answer(RestartAnswer answer) {
        std::uint32_t const seed = state_.question->seed;
        state_.question.reset();
        if (answer != RestartAnswer::cancel) {
            restart(seed, answer == RestartAnswer::overwrite);
        }
    }

    void restart(std::uint32_t seed, bool overwrite) {
        WindowState state;
        window_.write_place(state);
        if (!view_.shows_all()) {
            state.camera = view_.camera();
        }
        state.paused = requests_.status().paused;
        state.panels = state_.control;
        state.speed_up = requests_.status().asked_speed_up;
        state.options = options_;
        state.plot = state_.plot;
        state.column = state_.column;
        exchange_.send(Restart{seed, overwrite, state});
        setup_.hurry("restarting");
    }

    void quit() {
        closed_ = true;
        exchange_.send(Quit{});
        setup_.hurry("closing the window");
    }

    void show_help() {
        state_.help = !state_.help;
        if (state_.help && !help_is_logged_) {
            help_is_logged_ = true;
            for (Help const& line : help_lines()) {
                exchange_.send(Note{fmt::format("{:<20} {}", line.input, line.effect)});
            }
        }
    }

    // The view.

    void resize() {
        PictureSize const size = window_.size();
        canvas_.resize(size);
        view_.resize(size);
    }

    void reset_view() {
        options_.follow.reset();
        view_.show_all();
    }

    void pan(Vec2 motion_px) {
        options_.follow.reset();
        view_.pan(motion_px);
    }

    // The mouse.

    void take_wheel(SDL_MouseWheelEvent const& wheel) {
        float const lines = static_cast<float>(wheel.direction == SDL_MOUSEWHEEL_FLIPPED ? -wheel.y : wheel.y);
        if (panels_.has_mouse()) {
            wheel_ += lines;
        } else {
            view_.zoom(std::pow(kZoomStep, lines), mouse_.last().point_px);
        }
    }

    /// Two fingers zoom around the place between them. The first one, for which SDL presses the mouse, lets go.
    void take_pinch(SDL_MultiGestureEvent const& pinch) {
        drop();
        PictureSize const size = canvas_.size();
        view_.zoom(std::exp(kPinchZoom * pinch.dDist),
                   {pinch.x * static_cast<float>(size.width_px), pinch.y * static_cast<float>(size.height_px)});
    }

    void take_press(SDL_MouseButtonEvent const& button) {
        Vec2 const point_px = window_.to_pixels(button.x, button.y);
        mouse_.move(point_px);
        if (button.button != SDL_BUTTON_LEFT) {
            if (!panels_.has_mouse()) {
                pointer_.panned_from_px = point_px;
            }
            return;
        }
        mouse_.set_left(point_px, true);
        if (panels_.has_mouse() || moment_.newest() == nullptr) {
            return;
        }
        Snapshot const& snapshot = moment_.on_screen().snapshot;
        Vec2 const point_mm = view_.to_mm(point_px);
        Press press;
        press.start_px = point_px;
        press.object = moment_.past_time_s() ? std::nullopt : object_at(snapshot, point_mm, 0.0F);
        if (press.object) {
            Object const& object = snapshot.scenery->objects[*press.object];
            press.grip_mm = centre_of(snapshot, object) - point_mm;
        }
        pointer_.left = press;
    }

    void take_motion(Vec2 point_px) {
        mouse_.move(point_px);
        if (pointer_.panned_from_px) {
            pan(*pointer_.panned_from_px - point_px);
            pointer_.panned_from_px = point_px;
        }
        if (!pointer_.left) {
            return;
        }
        Press& press = *pointer_.left;
        press.is_drag = press.is_drag || length(point_px - press.start_px) > kTremblePx;
        if (press.is_drag && press.object) {
            send(DragObject{*press.object, view_.to_mm(point_px) + press.grip_mm});
        }
    }

    void take_release(SDL_MouseButtonEvent const& button) {
        if (button.button != SDL_BUTTON_LEFT) {
            pointer_.panned_from_px.reset();
            return;
        }
        mouse_.set_left(window_.to_pixels(button.x, button.y), false);
        if (pointer_.left && !pointer_.left->is_drag) {
            select(pointer_.left->start_px);
        }
        drop();
    }

    void drop() {
        if (pointer_.left && pointer_.left->is_drag && pointer_.left->object) {
            send(DropObject{});
        }
        pointer_.left.reset();
        pointer_.panned_from_px.reset();
    }

    /// The nearest robot, or none; the same one again: none.
    void select(Vec2 point_px) {
        float const margin_mm = kPickMarginPx / view_.camera().scale_px_mm;
        auto const robot = robot_at(moment_.on_screen().snapshot, view_.to_mm(point_px), margin_mm);
        bool const again = robot == options_.selected_robot;
        options_.selected_robot = again ? std::nullopt : robot;
        if (options_.selected_robot && !moment_.past_time_s()) {
            send(ClickRobot{*options_.selected_robot});
        }
    }

    // Pictures.

    void ask() {
        last_asked_ = Clock::now();
        SnapshotParts parts = parts_for(options_);
        parts.trails = options_.trails && (requests_.status().paused || !moment_.has_fresh_trails());
        exchange_.request({.parts = parts, .robot = options_.selected_robot});
    }

    void take_moment() {
        std::shared_ptr<Moment const> const newest = exchange_.take_moment();
        if (newest == nullptr) {
            return;
        }
        for (RecordedValues const& recorded : newest->recorded) {
            history_.add(recorded);
        }
        last_moment_ = Clock::now();
        // While the run is paused, only the user changes anything.
        Moment const* const before = moment_.newest();
        bool const ends = before != nullptr && newest->status.is_over != before->status.is_over;
        is_stale_ = is_stale_ || before == nullptr || newest->snapshot.step != before->snapshot.step ||
                    newest->status.touched != before->status.touched || ends;
        if (ends) {
            pictures_to_draw_ = kPicturesAfterInput;  // panels settle
        }
        moment_.take(*newest, options_.trails);
        requests_.take(newest->status);
    }

    /// Finds the moment that is to be drawn.
    void choose_moment() {
        moment_.choose();
        state_.looked_at_s = moment_.past_time_s();
        state_.newest_s = moment_.newest()->snapshot.time_s;
        state_.moment = &moment_.on_screen();
        if (options_.follow) {
            view_.centre_on(camera_for(options_, moment_.on_screen().snapshot, canvas_.size()).centre_mm);
        }
    }

    bool message_is_over(Clock::time_point now) const { return !state_.message.empty() && now > message_until_; }

    void draw(Clock::time_point now) {
        if (moment_.newest() == nullptr) {
            return;
        }
        if (message_is_over(now)) {
            state_.message.clear();
        }
        resize();
        choose_moment();
        painter_.paint(canvas_, view_.camera(), moment_.on_screen().snapshot, options_);
        PanelInput input = std::exchange(typed_, {});
        input.mouse = mouse_.take();
        input.wheel = std::exchange(wheel_, 0.0F);
        input.seconds = std::chrono::duration<float>(now - last_drawn_).count();
        last_drawn_ = now;
        panels_.draw(canvas_, input, state_,
                     {.send = [this](Command const& command) { send(command); },
                      .save_picture = [this] { picture_is_asked_ = true; },
                      .answer = [this](RestartAnswer asked) { answer(asked); },
                      .look_at = [this](double time_s) { look_at(time_s); },
                      .look_at_newest = [this] { moment_.look_at_newest(); }});
        window_.take_text(panels_.wants_text());
        window_.show(canvas_);
        if (std::exchange(picture_is_asked_, false)) {
            say(save_screenshot(canvas_));
        }
        is_stale_ = false;
        pictures_to_draw_ = std::max(pictures_to_draw_ - 1, 0);
    }

    void say(std::string const& text) {
        state_.message = text;
        message_until_ = Clock::now() + kMessageTime + static_cast<int>(text.size()) * kReadingTime;
        exchange_.send(Note{text});
    }

    WindowSetup setup_;
    Exchange& exchange_;
    SdlWindow window_;
    Panels panels_;
    Canvas canvas_;
    Painter painter_;
    ColumnHistory history_;
    ViewOptions options_;
    ArenaView view_;
    RunRequests requests_;
    ShownMoment moment_;
    PanelInput typed_;  // text and keys since the last picture
    PanelState state_;
    MouseStates mouse_;
    float wheel_ = 0.0F;  // lines up since the last picture, over a panel
    Pointer pointer_;
    bool closed_ = false;
    bool is_stale_ = true;
    bool help_is_logged_ = false;
    bool picture_is_asked_ = false;  // by a button
    int pictures_to_draw_ = kPicturesAfterInput;
    Clock::time_point last_drawn_ = Clock::now();
    Clock::time_point last_asked_ = Clock::now();
    Clock::time_point last_moment_ = Clock::now();
    Clock::time_point message_until_{};
};

/// Opens the window and runs it until it is closed, in the thread that calls it.
void show_window(WindowSetup const& setup, Exchange& exchange) {
    static sigjmp_buf lost;
    static Window* window = nullptr;  // out of reach of the jump
    if (sigsetjmp(lost, 0) != 0) {
        // SDL and Xlib were interrupted: their resources are not released.
        exchange.report_end(WindowEnd::display_lost, "");
        exchange.report_opened("the display is gone");
        return;
    }
    jump_when_display_is_lost(lost);
    try {
        window = new Window(setup, exchange);
    } catch (std::exception const& error) {
        exchange.report_end(WindowEnd::failed, error.what());
        exchange.report_opened(error.what());
        return;
    }
    exchange.report_opened("");
    WindowEnd end = WindowEnd::closed;
    std::string problem;
    try {
        window->run();
    } catch (std::exception const& error) {
        end = WindowEnd::failed;
        problem = error.what();
    }
    delete window;
    exchange.report_end(end, problem);
}

}  // namespace

}  // namespace pogosim

extern "C" __attribute__((visibility("default"))) void pogosim_show_window(pogosim::WindowSetup const& setup,
                                                                           pogosim::Exchange& exchange) {
    pogosim::show_window(setup, exchange);
}

#include "view/actions.hpp"

#include <SDL.h>

#include <array>

#include "view/switches.hpp"

namespace pogosim {

namespace {

enum class Shift { any, up, down };

struct Binding {
    SDL_Keycode key;
    Action action;
    Shift shift = Shift::any;
    bool repeats = false;  // while the key is held down; a switch would flicker
};
constexpr bool kRepeats = true;

constexpr std::array kBindings{
    Binding{SDLK_F1, Action::help},
    Binding{SDLK_F3, Action::slower, Shift::any, kRepeats},
    Binding{SDLK_F4, Action::faster, Shift::any, kRepeats},
    Binding{SDLK_F9, Action::panels},
    Binding{SDLK_F11, Action::full_screen},
    Binding{SDLK_F12, Action::screenshot},
    Binding{SDLK_f, Action::follow},
    Binding{SDLK_COMMA, Action::look_back, Shift::any, kRepeats},
    Binding{SDLK_PERIOD, Action::look_forward, Shift::any, kRepeats},
    Binding{SDLK_END, Action::look_at_newest},
    Binding{SDLK_ESCAPE, Action::quit},
    Binding{SDLK_SPACE, Action::pause},
    Binding{SDLK_KP_SPACE, Action::pause},
    Binding{SDLK_s, Action::step, Shift::any, kRepeats},
    Binding{SDLK_r, Action::restart, Shift::up},
    Binding{SDLK_r, Action::restart_with_next_seed, Shift::down},
    Binding{SDLK_LEFT, Action::pan_left, Shift::any, kRepeats},
    Binding{SDLK_KP_4, Action::pan_left, Shift::any, kRepeats},
    Binding{SDLK_RIGHT, Action::pan_right, Shift::any, kRepeats},
    Binding{SDLK_KP_6, Action::pan_right, Shift::any, kRepeats},
    Binding{SDLK_UP, Action::pan_up, Shift::any, kRepeats},
    Binding{SDLK_KP_8, Action::pan_up, Shift::any, kRepeats},
    Binding{SDLK_DOWN, Action::pan_down, Shift::any, kRepeats},
    Binding{SDLK_KP_2, Action::pan_down, Shift::any, kRepeats},
    Binding{SDLK_PLUS, Action::zoom_in, Shift::any, kRepeats},
    Binding{SDLK_EQUALS, Action::zoom_in, Shift::any, kRepeats},  // the key of + on many keyboards
    Binding{SDLK_KP_PLUS, Action::zoom_in, Shift::any, kRepeats},
    Binding{SDLK_MINUS, Action::zoom_out, Shift::any, kRepeats},
    Binding{SDLK_UNDERSCORE, Action::zoom_out, Shift::any, kRepeats},
    Binding{SDLK_KP_MINUS, Action::zoom_out, Shift::any, kRepeats},
    Binding{SDLK_0, Action::reset_view},
    Binding{SDLK_KP_0, Action::reset_view},
};

// The help has the switches of the picture between these two.
constexpr std::array kHelpOfTheRun{
    Help{"F1", "show or hide this help"},       Help{"Space", "pause, or go on"},
    Help{"S", "pause and advance by one step"}, Help{"F3, F4", "slower, faster"},
    Help{"R", "restart with the same seed"},    Help{"Shift R", "restart with the next seed"},
};
constexpr std::array kHelpOfTheView{
    Help{"F", "follow the selected robot"},
    Help{"comma, period, End", "look at the moment before, the one after, the newest"},
    Help{"F9", "show or hide the panels"},
    Help{"F11", "full screen"},
    Help{"F12", "save a screenshot"},
    Help{"arrows, right drag", "move the view"},
    Help{"+, -, wheel, two fingers", "zoom"},
    Help{"0", "fit the arena"},
    Help{"left click", "select a robot (callback_robot_click), or none"},
    Help{"left drag", "move a robot or a passive object"},
    Help{"Esc", "end the run"},
};

}  // namespace

std::optional<Action> action_of(std::int32_t key, bool shift, bool is_repeated) {
    for (Binding const& binding : kBindings) {
        bool const fits = binding.shift == Shift::any || (binding.shift == Shift::down) == shift;
        if (binding.key == key && fits && (binding.repeats || !is_repeated)) {
            return binding.action;
        }
    }
    return std::nullopt;
}

std::vector<Help> help_lines() {
    std::vector<Help> lines(kHelpOfTheRun.begin(), kHelpOfTheRun.end());
    for (std::span<Switch const> const group : all_switches()) {
        for (Switch const& one : group) {
            if (one.key != 0) {
                lines.push_back({one.key_name, one.effect});
            }
        }
    }
    lines.insert(lines.end(), kHelpOfTheView.begin(), kHelpOfTheView.end());
    return lines;
}

}  // namespace pogosim

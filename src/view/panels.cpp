#include "view/panels.hpp"

#include <fmt/format.h>

#include <SDL_clipboard.h>
#include <SDL_keycode.h>
#include <SDL_stdinc.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "render/text.hpp"
#include "view/actions.hpp"
#include "view/switches.hpp"

namespace pogosim {

namespace {

constexpr float kTextPx = 15.0F;
constexpr float kPlainTextPx = 13.0F;  // of the font that Dear ImGui has itself
constexpr float kMarginPx = 10.0F;
ImVec4 const kWarning{1.0F, 0.66F, 0.25F, 1.0F};
constexpr ImGuiWindowFlags kFixed =
    ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoSavedSettings;

void set_style(float scale) {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.AntiAliasedLinesUseTex = false;  // the raster draws triangles, not textures
    style.WindowRounding = 5.0F;
    style.FrameRounding = 3.0F;
    style.GrabRounding = 3.0F;
    style.WindowBorderSize = 0.0F;
    style.WindowPadding = {10.0F, 8.0F};
    style.ItemSpacing = {7.0F, 5.0F};
    style.Colors[ImGuiCol_WindowBg] = {0.09F, 0.10F, 0.13F, 0.88F};
    style.Colors[ImGuiCol_TitleBg] = {0.07F, 0.08F, 0.10F, 0.92F};
    style.Colors[ImGuiCol_TitleBgActive] = {0.12F, 0.15F, 0.20F, 0.95F};
    style.Colors[ImGuiCol_TitleBgCollapsed] = {0.07F, 0.08F, 0.10F, 0.80F};
    style.Colors[ImGuiCol_PlotHistogram] = {0.31F, 0.55F, 0.85F, 1.0F};
    style.ScaleAllSizes(scale);
}

/// Within the panel, on several lines where it is long.
void text(std::string const& text) {
    ImGui::PushTextWrapPos(0.0F);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
}

void text(ImVec4 const& colour, std::string const& of_colour) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    text(of_colour);
    ImGui::PopStyleColor();
}

std::string speed_text(double speed_up) {
    return speed_up >= 100.0 ? fmt::format("{:.0f} x", speed_up) : fmt::format("{:.3g} x", speed_up);
}

void draw_speed(PanelState const& state, std::function<void(Command const&)> const& send) {
    RunStatus const& status = *state.status;
    constexpr float kSlowest = 0.05F;
    constexpr float kFastest = 1000.0F;
    bool unlimited = status.asked_speed_up == 0.0;
    auto asked = static_cast<float>(status.asked_speed_up);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("speed");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-ems(4.4F));  // room for "max"
    char const* const format = unlimited ? "no limit" : "%.3g x";
    float shown = unlimited ? kFastest : asked;
    if (ImGui::SliderFloat("##speed", &shown, kSlowest, kFastest, format,
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoInput)) {
        send(SetSpeedUp{static_cast<double>(shown)});
    }
    ImGui::SameLine();
    if (ImGui::Checkbox("max", &unlimited)) {
        send(SetSpeedUp{unlimited ? 0.0 : 1.0});
    }
    if (state.seconds_since_moment > kBusyS) {
        text(kWarning, fmt::format("busy with one step for {:.0f} s", state.seconds_since_moment));
    } else if (status.paused && !status.why_paused.empty()) {
        text(kWarning, "paused: " + status.why_paused);
    } else if (status.paused) {
        ImGui::TextUnformatted("paused");
    } else if (status.too_slow) {
        text(kWarning, fmt::format("the machine reaches only {}", speed_text(status.speed_up)));
    } else if (status.speed_up > 0.0) {
        text(fmt::format("running at {} real time", speed_text(status.speed_up)));
    } else {
        ImGui::TextUnformatted("running");
    }
}

/// A choice among names, the first line standing for none of them.
void choose(char const* label, char const* none, std::vector<std::string> const& names, std::string& chosen) {
    ImGui::SetNextItemWidth(ems(7.5F));
    if (ImGui::BeginCombo(label, chosen.empty() ? none : chosen.c_str())) {
        if (ImGui::Selectable(none, chosen.empty())) {
            chosen.clear();
        }
        for (std::string const& name : names) {
            if (ImGui::Selectable(name.c_str(), name == chosen)) {
                chosen = name;
            }
        }
        ImGui::EndCombo();
    }
}

/// Gives a text that is being edited the room that it needs.
int make_room(ImGuiInputTextCallbackData* data) {
    if (data->EventFlag == ImGuiInputTextFlags_CallbackResize) {
        auto& text = *static_cast<std::string*>(data->UserData);
        text.resize(static_cast<std::size_t>(data->BufTextLen));
        data->Buf = text.data();
    }
    return 0;
}

/// A field for a text of any length. Returns whether Enter was pressed in it.
bool edit(char const* label, std::string& text) {
    return ImGui::InputText(label, text.data(), text.capacity() + 1,
                            ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackResize, make_room,
                            &text);
}

/// A field for the condition to pause by.
void draw_condition(PanelState& state, std::function<void(Command const&)> const& send) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("pause when");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1.0F);
    bool const is_entered = edit("##condition", state.condition);
    if (is_entered || ImGui::IsItemDeactivatedAfterEdit()) {
        send(PauseWhen{state.condition});
    }
    if (!state.status->wrong_condition.empty()) {
        text(kWarning, state.status->wrong_condition);
    }
}

void draw_switch(Switch const& one, ViewOptions& options) {
    if (one.is_beside) {
        ImGui::SameLine();
    }
    int choice = one.get(options);
    bool is_on = choice != 0;
    if (one.choices == nullptr) {
        if (ImGui::Checkbox(one.label, &is_on)) {
            one.set(options, is_on ? 1 : 0);
        }
        return;
    }
    ImGui::SetNextItemWidth(ems(6.0F));
    if (ImGui::Combo(one.label, &choice, one.choices)) {
        one.set(options, choice);
    }
}

void draw_group(std::span<Switch const> switches, ViewOptions& options) {
    for (Switch const& one : switches) {
        if (one.label != nullptr) {
            draw_switch(one, options);
        }
    }
}

/// Returns whether they are shown.
bool draw_switches(PanelState& state, std::function<void(Command const&)> const& send) {
    ViewOptions& options = *state.options;
    if (!ImGui::CollapsingHeader("View")) {
        return false;
    }
    draw_group(layer_switches(), options);
    ImGui::Checkbox("plot of a data column", &state.plot);
    draw_group(mark_switches(), options);
    choose("colours", "LEDs", state.setup->values, options.color_by);
    std::vector<std::string> maps{kDensity};
    maps.insert(maps.end(), state.setup->values.begin(), state.setup->values.end());
    choose("heat map", "none", maps, options.heat_map);
    draw_group(colour_switches(), options);
    draw_condition(state, send);
    return true;
}

void draw_buttons(PanelState const& state, PanelActions const& actions) {
    RunStatus const& status = *state.status;
    ImGui::BeginDisabled(status.is_over);
    if (ImGui::Button(status.paused && !status.is_over ? "Run" : "Pause", {ems(4.4F), 0.0F})) {
        actions.send(Pause{!status.paused});
    }
    ImGui::SameLine();
    if (ImGui::Button("Step")) {
        actions.send(StepOnce{});
    }
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::Button("Restart")) {
        actions.send(Restart{state.setup->seed});
    }
}

/// The choices when the simulated time is over.
void draw_end(PanelActions const& actions) {
    text(kWarning, "over: its files are complete");
    if (ImGui::Button("Save a picture")) {
        actions.save_picture();
    }
    ImGui::SameLine();
    if (ImGui::Button("Close")) {
        actions.send(Quit{});
    }
}

/// The time as a slider over the whole run, by which moments that are kept are looked at again.
void draw_time_line(PanelState const& state, PanelActions const& actions) {
    double const shown_s = state.looked_at_s.value_or(state.newest_s);
    double const duration_s = std::max(state.setup->duration_s, state.newest_s);
    auto value = static_cast<float>(shown_s);
    ImGui::SetNextItemWidth(-1.0F);
    std::string const format = fmt::format("{:.2f} of {:g} s", shown_s, state.setup->duration_s);
    if (ImGui::SliderFloat("##time", &value, 0.0F, static_cast<float>(duration_s), format.c_str(),
                           ImGuiSliderFlags_NoInput)) {
        actions.look_at(static_cast<double>(value));
    }
}

/// What can be done with a moment of the past.
void draw_past(PanelState const& state, PanelActions const& actions) {
    if (!state.looked_at_s) {
        return;
    }
    if (ImGui::Button("Now")) {
        actions.look_at_newest();
    }
    ImGui::SameLine();
    RunStatus const& status = *state.status;
    bool const is_kept = status.why_no_way_back.empty() && *state.looked_at_s >= status.earliest_s && !status.is_over;
    ImGui::BeginDisabled(!is_kept);
    if (ImGui::Button("Go on from here")) {
        actions.send(GoBack{*state.looked_at_s});
        actions.look_at_newest();
    }
    ImGui::EndDisabled();
    if (!status.why_no_way_back.empty()) {
        text(fmt::format("the run cannot go back: {}", status.why_no_way_back));
    } else if (status.is_over) {
        ImGui::TextUnformatted("the run is over");
    } else if (!is_kept) {
        text(fmt::format("the run can go back to {:.2f} s at the earliest", status.earliest_s));
    }
    if (state.options->selected_robot && inspected(state) == nullptr) {
        text("no values of the robot were kept: it was not selected then");
    }
}

/// Returns whether its section "View" is open.
bool draw_control(PanelState& state, PanelActions const& actions) {
    WindowSetup const& setup = *state.setup;
    draw_buttons(state, actions);
    draw_time_line(state, actions);
    draw_past(state, actions);
    if (state.status->is_over) {
        draw_end(actions);
    } else {
        draw_speed(state, actions.send);
    }
    std::string const seed = fmt::format("seed {}{}", setup.seed, state.status->touched ? ", touched" : "");
    text(seed);
    float const beside_px = std::max(ImGui::CalcTextSize(seed.c_str()).x + ems(1.3F), 0.62F * ImGui::GetWindowWidth());
    if (beside_px + ImGui::CalcTextSize("F1: help").x < ImGui::GetWindowWidth()) {
        ImGui::SameLine(beside_px);
    }
    ImGui::TextDisabled("F1: help");
    return draw_switches(state, actions.send);
}

void draw_help(PanelState& state) {
    ImVec2 const size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5F * size.x, 0.5F * size.y}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowFocus();
    if (ImGui::Begin("Keys and mouse", &state.help,
                     kFixed | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse) &&
        ImGui::BeginTable("help", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (Help const& line : help_lines()) {
            ImGui::TableNextColumn();
            ImGui::TextColored(kWarning, "%s", line.input);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(line.effect);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

void draw_message(std::string const& text) {
    ImVec2 const size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5F * size.x, size.y - kMarginPx}, ImGuiCond_Always, {0.5F, 1.0F});
    ImGui::Begin("##message", nullptr,
                 kFixed | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoInputs |
                     ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::PushTextWrapPos(std::max(size.x - 6.0F * kMarginPx, kMarginPx));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

/// Shows what the keys do at the end of a run, while no panel does.
constexpr auto kEnd = "over: R runs it again, F12 saves a picture, Esc closes the window";

void draw_question(PanelState const& state, PanelActions const& actions) {
    ImVec2 const size = ImGui::GetIO().DisplaySize;
    RestartQuestion const question = *state.question;  // an answer takes it away
    ImGui::SetNextWindowPos({0.5F * size.x, 0.5F * size.y}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowFocus();
    if (ImGui::Begin("Run again", nullptr, kFixed | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse)) {
        ImGui::PushTextWrapPos(std::max(size.x - 6.0F * kMarginPx, kMarginPx));
        ImGui::TextUnformatted(
            fmt::format("Run again with seed {}: keep the files of this run?", question.seed).c_str());
        for (std::string const& file : question.files) {
            ImGui::TextUnformatted(file.c_str());
        }
        ImGui::PopTextWrapPos();
        for (auto const& [label, answer] : {std::pair{"Keep them (K)", RestartAnswer::keep},
                                            std::pair{"Overwrite them (O)", RestartAnswer::overwrite},
                                            std::pair{"Cancel (Esc)", RestartAnswer::cancel}}) {
            bool const fits = ImGui::GetItemRectMax().x + ImGui::CalcTextSize(label).x + 4.0F * kMarginPx < size.x;
            if (answer != RestartAnswer::keep && fits) {
                ImGui::SameLine();
            }
            if (ImGui::Button(label)) {
                actions.answer(answer);
                break;
            }
        }
    }
    ImGui::End();
}

/// A key that is down for one picture.
void press_key(ImGuiIO& io, ImGuiKey key, bool is_down) {
#if IMGUI_VERSION_NUM >= 18700
    io.AddKeyEvent(key, is_down);
#else
    io.KeyMap[key] = static_cast<int>(key);
    io.KeysDown[key] = is_down;
#endif
}

/// Keys that edit a field.
struct EditingKey {
    std::int32_t sdl;
    ImGuiKey imgui;
};
constexpr std::array kEditingKeys{
    EditingKey{SDLK_BACKSPACE, ImGuiKey_Backspace},
    EditingKey{SDLK_DELETE, ImGuiKey_Delete},
    EditingKey{SDLK_RETURN, ImGuiKey_Enter},
    EditingKey{SDLK_ESCAPE, ImGuiKey_Escape},
    EditingKey{SDLK_LEFT, ImGuiKey_LeftArrow},
    EditingKey{SDLK_RIGHT, ImGuiKey_RightArrow},
    EditingKey{SDLK_HOME, ImGuiKey_Home},
    EditingKey{SDLK_END, ImGuiKey_End},
    EditingKey{SDLK_a, ImGuiKey_A},
    EditingKey{SDLK_c, ImGuiKey_C},
    EditingKey{SDLK_v, ImGuiKey_V},
    EditingKey{SDLK_x, ImGuiKey_X},
    EditingKey{SDLK_y, ImGuiKey_Y},
    EditingKey{SDLK_z, ImGuiKey_Z},
};

void press_keys(ImGuiIO& io, PanelInput const& input) {
#if IMGUI_VERSION_NUM >= 18900
    io.AddKeyEvent(ImGuiMod_Ctrl, input.ctrl);
    io.AddKeyEvent(ImGuiMod_Shift, input.shift);
#elif IMGUI_VERSION_NUM >= 18700
    io.AddKeyEvent(ImGuiKey_ModCtrl, input.ctrl);
    io.AddKeyEvent(ImGuiKey_ModShift, input.shift);
#else
    io.KeyCtrl = input.ctrl;
    io.KeyShift = input.shift;
#endif
    for (EditingKey const& key : kEditingKeys) {
        press_key(io, key.imgui, std::ranges::find(input.keys, key.sdl) != input.keys.end());
    }
}

char const* clipboard_text() {
    static std::string text;
    if (char* const copied = SDL_GetClipboardText()) {
        text = copied;
        SDL_free(copied);
    }
    return text.c_str();
}

/// Copies from fields to other windows, and back.
void use_clipboard() {
#if IMGUI_VERSION_NUM >= 19110
    ImGui::GetPlatformIO().Platform_GetClipboardTextFn = [](ImGuiContext*) { return clipboard_text(); };
    ImGui::GetPlatformIO().Platform_SetClipboardTextFn = [](ImGuiContext*, char const* text) {
        SDL_SetClipboardText(text);
    };
#else
    ImGui::GetIO().GetClipboardTextFn = [](void*) { return clipboard_text(); };
    ImGui::GetIO().SetClipboardTextFn = [](void*, char const* text) { SDL_SetClipboardText(text); };
#endif
}

/// A panel at its place, if that is to be set anew. Returns whether it is open.
bool begin_panel(char const* title, PanelBox const& box, bool in_its_place, bool* is_shown, ImGuiWindowFlags flags) {
    ImGuiCond const when = in_its_place ? ImGuiCond_Always : ImGuiCond_Appearing;
    ImGui::SetNextWindowPos({box.corner_px.x, box.corner_px.y}, when);
    ImGui::SetNextWindowCollapsed(box.is_collapsed, when);
    return ImGui::Begin(title, is_shown, flags | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoSavedSettings);
}

}  // namespace

Panels::Panels(float scale) : context_(ImGui::CreateContext()), scale_(scale) {
    ImGui::SetCurrentContext(context_.get());
    ImGuiIO& io = ImGui::GetIO();
    use_clipboard();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;  // long texts and plots have many corners
    set_style(scale);
    std::string const font(system_font());
    if (font.empty() || io.Fonts->AddFontFromFileTTF(font.c_str(), kTextPx * scale) == nullptr) {
        ImFontConfig plain;
        plain.SizePixels = kPlainTextPx * scale;
        io.Fonts->AddFontDefault(&plain);
    }
    atlas_ = make_glyph_atlas(*io.Fonts);
}

Panels::~Panels() = default;

bool Panels::wants_text() const {
    return ImGui::GetIO().WantTextInput;
}

Inspection const* inspected(PanelState const& state) {
    bool const is_there = state.moment != nullptr && state.moment->inspection &&
                          state.options->selected_robot == state.moment->inspection->robot;
    return is_there ? &*state.moment->inspection : nullptr;
}

bool Panels::has_mouse() const {
    return ImGui::GetIO().WantCaptureMouse;
}

PanelRoom Panels::room_now(PanelState const& state) const {
    ImVec2 const size = ImGui::GetIO().DisplaySize;
    PictureSize const picture{static_cast<int>(size.x), static_cast<int>(size.y)};
    Box const& bounds_mm = state.setup->scenery->arena.bounds;
    Camera const camera = fitted(bounds_mm, picture);
    PanelRoom room{.window_px = {size.x, size.y},
                   .arena_px = {camera.to_pixels(bounds_mm.min, picture), camera.to_pixels(bounds_mm.max, picture)},
                   .scale = scale_,
                   .title_px = ImGui::GetFrameHeight(),
                   .has_inspector = inspected(state) != nullptr,
                   .has_plot = state.plot};
    if (control_px_ > 0.0F) {
        room.control_px = control_px_;
        room.control_least_px = control_least_px_ > 0.0F ? control_least_px_ : control_px_;
    } else {
        room.control_px *= scale_;
        room.control_least_px *= scale_;
    }
    return room;
}

void Panels::draw_all(PanelState& state, PanelActions const& actions) {
    PanelRoom const room = room_now(state);
    PanelLayout const layout = lay_out_panels(room);
    bool const in_place = has_other_places(layout, layout_);
    layout_ = layout;

    float const title_width_px = kTitleWidthPx * scale_;
    float const control_width_px = kControlWidthPx * scale_;
    ImGui::SetNextWindowSize({control_is_open_ ? control_width_px : title_width_px, 0.0F});
    control_is_open_ = begin_panel("Run", layout.control, in_place, nullptr,
                                   ImGuiWindowFlags_NoResize | ImGuiWindowFlags_AlwaysAutoResize);
    if (control_is_open_ && state.moment != nullptr) {
        bool const shows_switches = draw_control(state, actions);
        control_px_ = ImGui::GetWindowHeight();
        control_least_px_ = shows_switches ? control_least_px_ : control_px_;
    }
    ImGui::End();

    if (room.has_inspector) {
        PanelBox box = layout.inspector;
        if (box.is_collapsed && inspector_is_open_) {  // the user has opened it nevertheless
            float const right_px = box.corner_px.x + box.size_px.x;
            box.size_px = {kInspectorWidthPx * scale_, room.window_px.y - box.corner_px.y - kMarginPx};
            box.corner_px.x = std::max(right_px - box.size_px.x, kMarginPx);
        }
        float const width_px = inspector_is_open_ ? box.size_px.x : title_width_px;
        ImGui::SetNextWindowSizeConstraints({width_px, 0.0F}, {width_px, box.size_px.y});
        ImGui::SetNextWindowSize({width_px, 0.0F});
        std::string const title = fmt::format("Robot {}###inspector", inspected(state)->id);
        bool const was_open = inspector_is_open_;
        inspector_is_open_ = begin_panel(title.c_str(), box, in_place, nullptr, ImGuiWindowFlags_NoResize);
        if (inspector_is_open_ != was_open && !in_place) {
            ImGui::SetWindowPos({inspector_is_open_
                                     ? std::max(room.window_px.x - kMarginPx - kInspectorWidthPx * scale_, kMarginPx)
                                     : room.window_px.x - kMarginPx - title_width_px,
                                 box.corner_px.y});
        }
        if (inspector_is_open_) {
            draw_inspector(*inspected(state));
        }
        ImGui::End();
    }

    if (room.has_plot) {
        PanelBox const& box = layout.plot;
        if (in_place) {
            ImGui::SetNextWindowSize({box.size_px.x, box.size_px.y});
        }
        Vec2 const least_px = plot_is_open_ ? scale_ * kLeastPlotPx : Vec2{title_width_px, room.title_px};
        ImGui::SetNextWindowSizeConstraints({least_px.x, least_px.y}, {room.window_px.x, room.window_px.y});
        plot_is_open_ = begin_panel("Data column", box, in_place, &state.plot, 0);
        if (plot_is_open_) {
            draw_plot(state);
        }
        ImGui::End();
    }
}

void Panels::draw(Canvas& canvas, PanelInput const& input, PanelState& state, PanelActions const& actions) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(canvas.size().width_px), static_cast<float>(canvas.size().height_px)};
    io.DeltaTime = std::max(input.seconds, 1e-4F);
    io.MousePos = {input.mouse.point_px.x, input.mouse.point_px.y};
    io.MouseDown[0] = input.mouse.left_is_down;
    io.MouseWheel = input.wheel;
    io.AddInputCharactersUTF8(input.text.c_str());
    press_keys(io, input);
    ImGui::NewFrame();
    bool const shows_panels = state.control && has_room_for_panels({io.DisplaySize.x, io.DisplaySize.y}, scale_);
    if (shows_panels) {
        draw_all(state, actions);
    }
    if (state.help) {
        draw_help(state);
    }
    if (state.question) {
        draw_question(state, actions);
    }
    if (!state.message.empty()) {
        draw_message(state.message);
    } else if (state.status->is_over && !(shows_panels && control_is_open_)) {
        draw_message(kEnd);
    }
    ImGui::Render();
    draw_panels(canvas, *ImGui::GetDrawData(), atlas_);
}

}  // namespace pogosim

/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The panels, drawn by Dear ImGui: C++ because it is, and only here. See panel.h. Lengths are the window's units times the
 * display's scale.
 */
#include "player/window/panel.h"

#ifdef HAVE_IMGUI

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <unistd.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <fap/face.h>
#include <fap/tables.h>

extern "C" {
#include "player/window/keys.h"
}

struct panel {
    ImGuiContext *context;
    ImFont *text, *small;
    float scale; /* of all lengths */
};

namespace
{

const float bar_height = 94, bars_width = 320, text_px = 16, small_px = 13, button = 32, edge = 14,
            narrow = 800;

const ImVec4 back(0.085f, 0.095f, 0.115f, 1), raised(0.15f, 0.165f, 0.195f, 1), hover(0.21f, 0.23f, 0.27f, 1),
    accent(0.31f, 0.56f, 0.88f, 1), words(0.87f, 0.89f, 0.92f, 1), quiet(0.56f, 0.60f, 0.66f, 1);

/* What a call of panel_draw() works on. */
struct pass {
    const panel *p;
    const panel_view *v;
    const session *s;
    play_event *event;
    int room, count;
};

void emit(pass *d, play_action action, double value)
{
    if (d->count < d->room)
        d->event[d->count++] = { action, value, 0 };
}

ImU32 colour(ImVec4 c, float alpha = 1)
{
    c.w *= alpha;
    return ImGui::GetColorU32(c);
}

/* "1:02.345" */
void time_text(char *text, size_t room, int64_t at_us)
{
    const int64_t ms = at_us / 1000;
    snprintf(text, room, "%" PRId64 ":%02d.%03d", ms / 60000, static_cast<int>(ms / 1000 % 60),
             static_cast<int>(ms % 1000));
}

/* --- small parts --- */

enum icon { ICON_START, ICON_BACK, ICON_PLAY, ICON_PAUSE, ICON_ON };

void triangle(ImDrawList *l, ImVec2 c, float r, int right, ImU32 ink)
{
    const float tip = right ? r : -r;
    const ImVec2 a(c.x + tip, c.y), b(c.x - tip, c.y - r), e(c.x - tip, c.y + r);

    if (right)
        l->AddTriangleFilled(a, e, b, ink);
    else
        l->AddTriangleFilled(a, b, e, ink);
}

void upright(ImDrawList *l, ImVec2 c, float half, float r, ImU32 ink)
{
    l->AddRectFilled(ImVec2(c.x - half, c.y - r), ImVec2(c.x + half, c.y + r), ink);
}

void draw_icon(icon which, ImVec2 c, float r, ImU32 ink)
{
    ImDrawList *l = ImGui::GetWindowDrawList();

    switch (which) {
    case ICON_PLAY: triangle(l, ImVec2(c.x + 0.1f * r, c.y), r, 1, ink); break;
    case ICON_PAUSE:
        upright(l, ImVec2(c.x - 0.5f * r, c.y), 0.27f * r, r, ink);
        upright(l, ImVec2(c.x + 0.5f * r, c.y), 0.27f * r, r, ink);
        break;
    case ICON_START:
        upright(l, ImVec2(c.x - 0.8f * r, c.y), 0.16f * r, 0.8f * r, ink);
        triangle(l, ImVec2(c.x + 0.25f * r, c.y), 0.8f * r, 0, ink);
        break;
    case ICON_BACK:
    case ICON_ON: {
        const float side = which == ICON_ON ? 1.f : -1.f;
        upright(l, ImVec2(c.x - side * 0.75f * r, c.y), 0.16f * r, 0.7f * r, ink);
        triangle(l, ImVec2(c.x + side * 0.25f * r, c.y), 0.7f * r, which == ICON_ON, ink);
        break;
    }
    }
}

void tip(const pass *d, const char *text)
{
    if (!ImGui::IsItemHovered())
        return;
    ImGui::PushFont(d->p->small);
    ImGui::SetTooltip("%s", text);
    ImGui::PopFont();
}

int icon_button(const pass *d, const char *name, icon which, const char *help)
{
    const float side = button * d->p->scale;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const int pressed = ImGui::Button(name, ImVec2(side, side));

    draw_icon(which, ImVec2(at.x + side / 2, at.y + side / 2), 0.2f * side, colour(words));
    tip(d, help);
    return pressed;
}

/* Lit while on. */
int toggle(const pass *d, const char *name, int on, float width, const char *help)
{
    ImGui::PushStyleColor(ImGuiCol_Button, on ? accent : raised);
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, on ? accent : hover);
    const int pressed = ImGui::Button(name, ImVec2(width, button * d->p->scale));
    ImGui::PopStyleColor(2);
    tip(d, help);
    return pressed;
}

/* --- timeline --- */

void draw_track(const pass *d, ImVec2 at, float width, float height, float share)
{
    const float scale = d->p->scale, y = at.y + height / 2, thick = 3 * scale;
    const float x = at.x + share * width,
                r = (ImGui::IsItemHovered() || ImGui::IsItemActive() ? 8 : 6) * scale;
    ImDrawList *l = ImGui::GetWindowDrawList();

    l->AddRectFilled(ImVec2(at.x, y - thick), ImVec2(at.x + width, y + thick), colour(raised), thick);
    l->AddRectFilled(ImVec2(at.x, y - thick), ImVec2(x, y + thick), colour(accent), thick);
    l->AddCircleFilled(ImVec2(x, y), r, colour(words));
}

void timeline_tip(const pass *d, double share)
{
    char at[32];
    const int64_t us = static_cast<int64_t>(share * static_cast<double>(d->s->length_us));

    time_text(at, sizeof at, us);
    ImGui::PushFont(d->p->small);
    ImGui::SetTooltip("%s   frame %.0f", at, std::floor(static_cast<double>(us + 2) * d->s->rate_hz * 1e-6));
    ImGui::PopFont();
}

/* A press anywhere goes there, and follows the mouse. */
void timeline_bar(pass *d, float width)
{
    const float height = button * d->p->scale;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const double length_s = static_cast<double>(d->s->length_us) * 1e-6;

    ImGui::InvisibleButton("timeline", ImVec2(width, height));
    const double x = static_cast<double>(ImGui::GetIO().MousePos.x - at.x) / static_cast<double>(width);
    const double share = x < 0 ? 0 : x > 1 ? 1 : x;
    if (ImGui::IsItemActive())
        emit(d, PLAY_SEEK, share * length_s);
    if (ImGui::IsItemHovered() || ImGui::IsItemActive())
        timeline_tip(d, share);
    draw_track(d, at, width, height,
               static_cast<float>(d->s->at_us) /
                   static_cast<float>(d->s->length_us > 0 ? d->s->length_us : 1));
}

void timeline_row(pass *d)
{
    char at[32], length[32];
    const float gap = ImGui::GetStyle().ItemSpacing.x;

    time_text(at, sizeof at, d->s->at_us);
    time_text(length, sizeof length, d->s->length_us);
    const float wide = ImGui::CalcTextSize(length).x, from = ImGui::GetCursorPosX();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(at);
    ImGui::SameLine(from + wide + gap);
    timeline_bar(d, ImGui::GetContentRegionAvail().x - wide - gap);
    ImGui::SameLine();
    ImGui::TextColored(quiet, "%s", length);
}

/* --- buttons --- */

void transport(pass *d)
{
    if (icon_button(d, "##start", ICON_START, "to the beginning  (home)"))
        emit(d, PLAY_SEEK, 0);
    ImGui::SameLine();
    if (icon_button(d, "##back", ICON_BACK, "one frame back  (left)"))
        emit(d, PLAY_STEP, -1);
    ImGui::SameLine();
    if (icon_button(d, "##play", d->s->playing ? ICON_PAUSE : ICON_PLAY, "play, pause  (space)"))
        emit(d, PLAY_PAUSE, 0);
    ImGui::SameLine();
    if (icon_button(d, "##on", ICON_ON, "one frame on  (right)"))
        emit(d, PLAY_STEP, 1);
    ImGui::SameLine();
}

/* A row of choices with room for @width; -1: none was made. */
int choose(const pass *d, const char *name, float width, const char *now, const char *const *choice,
           int count, const char *help)
{
    int made = -1;

    ImGui::SetNextItemWidth(width);
    const int open =
        ImGui::BeginCombo(name, now, ImGuiComboFlags_HeightLargest | ImGuiComboFlags_NoArrowButton);
    if (!open) {
        tip(d, help);
        return -1;
    }
    for (int i = 0; i < count; i++)
        if (ImGui::Selectable(choice[i], !strcmp(choice[i], now)))
            made = i;
    ImGui::EndCombo();
    return made;
}

void choose_speed(pass *d, float width)
{
    static const char *const names[] = { "0.1x", "0.25x", "0.5x", "1x", "1.5x", "2x", "4x" };
    char now[16];

    snprintf(now, sizeof now, "%gx", d->s->speed);
    const int i = choose(d, "##speed", width, now, names, IM_ARRAYSIZE(names), "speed  (up, down)");
    if (i >= 0)
        emit(d, PLAY_SPEED, strtod(names[i], nullptr));
}

void choose_blend(pass *d, float width)
{
    const char *names[16];
    int count = 0;

    while (count < IM_ARRAYSIZE(names) && fap_blend_name(count)) {
        names[count] = fap_blend_name(count);
        count++;
    }
    const int i = choose(d, "##blend", width, fap_blend_name(d->s->blend), names, count, "blend method  (b)");
    if (i >= 0)
        emit(d, PLAY_BLEND, i);
}

void choose_view(pass *d, float width)
{
    const char *names[CAMERA_COUNT];

    for (int i = 0; i < CAMERA_COUNT; i++)
        names[i] = render_camera_name(static_cast<render_camera>(i));
    const int i = choose(d, "##view", width, d->s->camera >= 0 ? names[d->s->camera] : "free", names,
                         CAMERA_COUNT, "view  (1 to 4, r)");
    if (i >= 0)
        emit(d, PLAY_CAMERA, i);
}

void put_help(pass *d, float width)
{
    if (toggle(d, "?", d->s->help, width, "all keys  (?)"))
        emit(d, PLAY_HELP, 0);
}

void put_save(pass *d, float width)
{
    if (toggle(d, "save", 0, width, "save a picture  (s)"))
        emit(d, PLAY_SCREENSHOT, 0);
}

void put_bars(pass *d, float width)
{
    if (toggle(d, "FAPs", d->s->bars, width, "bars of the FAPs  (f)"))
        emit(d, PLAY_BARS, 0);
}

void put_points(pass *d, float width)
{
    if (toggle(d, "points", d->s->points, width, "feature points with their numbers  (p)"))
        emit(d, PLAY_POINTS, 0);
}

void put_wire(pass *d, float width)
{
    if (toggle(d, "wire", d->s->wireframe, width, "wireframe  (w)"))
        emit(d, PLAY_WIREFRAME, 0);
}

void put_loop(pass *d, float width)
{
    if (toggle(d, "loop", d->s->loop, width, "loop  (l)"))
        emit(d, PLAY_LOOP, 0);
}

/* From the right; in a narrow window the last ones have no room, and their keys remain. */
void right_side(pass *d, float from)
{
    static const struct {
        void (*put)(pass *, float);
        float width;
    } part[] = {
        { put_help, 32 },     { choose_speed, 60 }, { put_loop, 54 },
        { choose_blend, 72 }, { choose_view, 112 }, { put_points, 66 },
        { put_wire, 54 },     { put_bars, 60 },     { put_save, 58 },
    };
    const float gap = ImGui::GetStyle().ItemSpacing.x, y = ImGui::GetCursorPosY();
    float x = ImGui::GetWindowWidth() - edge * d->p->scale;

    for (const auto &b : part) {
        x -= b.width * d->p->scale;
        if (x < from)
            return;
        ImGui::SetCursorPos(ImVec2(x, y));
        b.put(d, b.width * d->p->scale);
        x -= gap;
    }
}

void button_row(pass *d)
{
    char text[128], now[32] = "";
    const float y = ImGui::GetCursorPosY();

    transport(d);
    if (d->v->kbit_s_now > 0 && ImGui::GetWindowWidth() >= narrow * d->p->scale)
        snprintf(now, sizeof now, ", now %.2f", d->v->kbit_s_now);
    snprintf(text, sizeof text, "frame %" PRId64 " / %" PRId64 "  \xc2\xb7  %g Hz  \xc2\xb7  %.3g kbit/s%s",
             session_frame(d->s), d->s->frame_count, d->s->rate_hz, d->v->kbit_s, now);
    ImGui::AlignTextToFramePadding();
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 6 * d->p->scale);
    ImGui::PushStyleColor(ImGuiCol_Text, quiet);
    ImGui::TextUnformatted(text);
    ImGui::PopStyleColor();
    ImGui::SameLine();
    const float from = ImGui::GetCursorPosX();
    ImGui::SetCursorPosY(y);
    right_side(d, from);
}

const ImGuiWindowFlags fixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                               ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                               ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus;

void bottom_bar(pass *d)
{
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float height = bar_height * d->p->scale;

    ImGui::SetNextWindowPos(ImVec2(0, size.y - height));
    ImGui::SetNextWindowSize(ImVec2(size.x, height));
    ImGui::Begin("controls", nullptr, fixed | ImGuiWindowFlags_NoScrollWithMouse);
    timeline_row(d);
    button_row(d);
    ImGui::End();
}

/* --- what is said over the face --- */

void shaded_text(ImDrawList *l, ImFont *font, ImVec2 at, ImU32 ink, const char *text)
{
    l->AddText(font, font->FontSize * ImGui::GetIO().FontGlobalScale, ImVec2(at.x + 1, at.y + 1),
               IM_COL32(0, 0, 0, 150), text);
    l->AddText(font, font->FontSize * ImGui::GetIO().FontGlobalScale, at, ink, text);
}

float text_width(ImFont *font, const char *text)
{
    return font->CalcTextSizeA(font->FontSize * ImGui::GetIO().FontGlobalScale, 1e6f, 0, text).x;
}

/* Ends in dots where there is no room for all of it; letters of UTF-8 stay whole. */
void shorten(ImFont *font, char *text, float room)
{
    size_t length = strlen(text);

    if (text_width(font, text) <= room)
        return;
    while (length > 0 && text_width(font, text) > room) {
        length--;
        while (length > 0 && (text[length] & 0xc0) == 0x80)
            length--;
        memcpy(text + length, "...", 4);
    }
}

void title_line(const pass *d, ImFont *font, float y, float alpha, char *text)
{
    const float x = edge * d->p->scale, right = d->s->bars ? bars_width * d->p->scale : 0;

    shorten(font, text, ImGui::GetIO().DisplaySize.x - right - 2 * x);
    shaded_text(ImGui::GetBackgroundDrawList(), font, ImVec2(x, y * d->p->scale),
                ImGui::GetColorU32(ImVec4(1, 1, 1, alpha)), text);
}

void title(const pass *d)
{
    char line[512];
    const panel_view *v = d->v;

    snprintf(line, sizeof line, "%.160s%s%.160s", v->stream, v->sound[0] ? "  +  " : "", v->sound);
    title_line(d, d->p->text, 10, 0.9f, line);
    snprintf(line, sizeof line, "%.160s  \xc2\xb7  %s  \xc2\xb7  %.2f mm before the residual%s%s", v->face,
             fap_blend_name(d->s->blend), v->error_mm, d->s->expression ? "  \xc2\xb7  " : "",
             d->s->expression ? fap_expression_name(d->s->expression) : "");
    title_line(d, d->p->small, 30, 0.67f, line);
}

void message(const pass *d)
{
    if (!d->v->message)
        return;
    ImGui::SetNextWindowPos(ImVec2(ImGui::GetIO().DisplaySize.x / 2, 52 * d->p->scale), 0, ImVec2(0.5f, 0));
    ImGui::SetNextWindowBgAlpha(0.88f);
    ImGui::Begin("message", nullptr, fixed | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
    ImGui::TextUnformatted(d->v->message);
    ImGui::End();
}

/* What labels take up of the window. */
struct label_places {
    ImVec4 taken[FAP_POINT_COUNT]; /* left, top, right, bottom */
    int count;
};

int is_free(const label_places *l, ImVec4 want)
{
    for (int i = 0; i < l->count; i++) {
        const ImVec4 &t = l->taken[i];
        if (want.x < t.z && t.x < want.z && want.y < t.w && t.y < want.w)
            return 0;
    }
    return 1;
}

/* To the right of its point, else to the left, above or below; one that has no room appears when the face is nearer. */
void put_label(const pass *d, const panel_label *b, label_places *l)
{
    const float aside = 5 * d->p->scale, high = small_px * d->p->scale,
                wide = text_width(d->p->small, b->text);
    const ImVec2 place[] = {
        ImVec2(b->x + aside, b->y - high / 2),
        ImVec2(b->x - aside - wide, b->y - high / 2),
        ImVec2(b->x - wide / 2, b->y - aside - high),
        ImVec2(b->x - wide / 2, b->y + aside),
    };

    for (const ImVec2 &at : place) {
        const ImVec4 want(at.x, at.y, at.x + wide, at.y + high);
        if (l->count >= FAP_POINT_COUNT || !is_free(l, want))
            continue;
        l->taken[l->count++] = want;
        shaded_text(ImGui::GetBackgroundDrawList(), d->p->small, at,
                    IM_COL32(255, 255, 255, b->faint ? 70 : 235), b->text);
        return;
    }
}

/* Those of the near side come first. */
void labels(const pass *d)
{
    label_places l = {};

    for (int faint = 0; faint < 2; faint++)
        for (int i = 0; i < d->v->label_count; i++)
            if (!d->v->label[i].faint == !faint)
                put_label(d, &d->v->label[i], &l);
}

/* --- bars of the FAPs --- */

ImVec4 state_colour(int state)
{
    switch (state) {
    case FAP_CODED: return accent;
    case FAP_DERIVED: return ImVec4(0.30f, 0.66f, 0.55f, 1);
    case FAP_CONCEALED: return ImVec4(0.86f, 0.42f, 0.36f, 1);
    default: return quiet;
    }
}

/* The farthest that the stream goes is the width of the bar. */
float bar_share(int32_t value, int32_t farthest)
{
    const float share = static_cast<float>(value) / static_cast<float>(farthest > 0 ? farthest : 1);
    return share < -1 ? -1 : share > 1 ? 1 : share;
}

void draw_bar(ImVec2 at, float width, float height, float share, ImU32 ink)
{
    ImDrawList *l = ImGui::GetWindowDrawList();
    const float middle = at.x + width / 2, end = middle + share * width / 2;

    l->AddRectFilled(at, ImVec2(at.x + width, at.y + height), colour(raised, 0.6f), 2);
    l->AddRectFilled(ImVec2(share < 0 ? end : middle, at.y), ImVec2(share < 0 ? middle : end, at.y + height),
                     ink);
    l->AddRectFilled(ImVec2(middle, at.y), ImVec2(middle + 1, at.y + height), colour(quiet));
}

void bar_row(const pass *d, int fap)
{
    const float scale = d->p->scale, from = ImGui::GetCursorPosX(), line = ImGui::GetTextLineHeight();
    const fap_info *info = fap_info_get(fap);
    const int32_t value = d->v->frame->value[fap];

    ImGui::TextColored(quiet, "%2d", fap);
    ImGui::SameLine(from + 22 * scale);
    ImGui::TextUnformatted(info->name);
    ImGui::SameLine(from + 158 * scale);
    ImVec2 at = ImGui::GetCursorScreenPos();
    at.y += 0.2f * line;
    draw_bar(at, 84 * scale, 0.65f * line, bar_share(value, d->v->farthest[fap]),
             colour(state_colour(d->v->frame->state[fap])));
    ImGui::SetCursorPosX(from + 248 * scale);
    ImGui::Text("%5d", value);
}

/* Visemes and expressions have names instead of a value. */
void high_level_rows(const pass *d)
{
    const fap_frame *f = d->v->frame;

    if (f->state[1] != FAP_ABSENT && fap_viseme_name(f->viseme.select1))
        ImGui::Text(" 1 viseme %s", fap_viseme_name(f->viseme.select1));
    if (f->state[2] != FAP_ABSENT && fap_expression_name(f->expression.select1))
        ImGui::Text(" 2 expression %s, %d / 63", fap_expression_name(f->expression.select1),
                    f->expression.intensity1);
}

void bars(const pass *d)
{
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float width = bars_width * d->p->scale, height = size.y - bar_height * d->p->scale;

    ImGui::SetNextWindowPos(ImVec2(size.x - width, 0));
    ImGui::SetNextWindowSize(ImVec2(width, height));
    ImGui::Begin("FAPs", nullptr, fixed & ~ImGuiWindowFlags_NoScrollbar);
    ImGui::PushFont(d->p->small);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(4 * d->p->scale, 2 * d->p->scale));
    ImGui::TextColored(accent, "sent");
    ImGui::SameLine();
    ImGui::TextColored(state_colour(FAP_HELD), "held");
    ImGui::SameLine();
    ImGui::TextColored(state_colour(FAP_DERIVED), "derived");
    ImGui::SameLine();
    ImGui::TextColored(state_colour(FAP_CONCEALED), "predicted");
    ImGui::Spacing();
    high_level_rows(d);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (d->v->frame->state[fap] != FAP_ABSENT)
            bar_row(d, fap);
    ImGui::PopStyleVar();
    ImGui::PopFont();
    ImGui::End();
}

/* --- the keys --- */

void help(pass *d)
{
    const ImVec2 size = ImGui::GetIO().DisplaySize;

    const float scale = d->p->scale;
    const int small = size.y < 740 * scale; /* the usual letters would not fit above the controls */
    const float left = size.y - bar_height * scale;

    ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(0, 0), size, IM_COL32(0, 0, 0, 110));
    ImGui::SetNextWindowPos(ImVec2(size.x / 2, left / 2), 0, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(size.x, left - 8 * scale));
    ImGui::SetNextWindowBgAlpha(0.96f);
    ImGui::SetNextWindowFocus();
    ImGui::Begin("keys", nullptr,
                 (fixed & ~(ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollbar)) |
                     ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PushFont(small ? d->p->small : d->p->text);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(6 * scale, (small ? 2 : 6) * scale));
    for (const play_key *k = play_keys; k->key; k++) {
        if (!k->label)
            continue;
        ImGui::TextColored(accent, "%s", k->label);
        ImGui::SameLine((small ? 150 : 170) * scale);
        ImGui::TextUnformatted(k->help);
    }
    ImGui::Spacing();
    ImGui::TextColored(quiet, "mouse: drag turns, right button moves, wheel zooms");
    ImGui::TextColored(quiet, "drop .fap, .fba, .fbank or a sound on the window");
    if (ImGui::IsMouseClicked(0) && ImGui::IsWindowHovered())
        emit(d, PLAY_HELP, 0);
    ImGui::PopStyleVar();
    ImGui::PopFont();
    ImGui::End();
}

/* --- from and to nothing --- */

void set_style(float scale)
{
    ImGuiStyle &s = ImGui::GetStyle();
    ImVec4 *c = s.Colors;

    ImGui::StyleColorsDark();
    s.WindowRounding = s.WindowBorderSize = s.FrameBorderSize = 0;
    s.FrameRounding = s.PopupRounding = s.GrabRounding = 5;
    s.WindowPadding = ImVec2(edge, 11);
    s.FramePadding = ImVec2(8, 8); /* with a line of text: a button's height */
    s.ItemSpacing = ImVec2(6, 8);
    s.ScrollbarSize = 10;
    s.ScaleAllSizes(scale);
    c[ImGuiCol_WindowBg] = back;
    c[ImGuiCol_PopupBg] = ImVec4(0.12f, 0.13f, 0.155f, 1);
    c[ImGuiCol_Text] = words;
    c[ImGuiCol_Button] = c[ImGuiCol_FrameBg] = raised;
    c[ImGuiCol_ButtonHovered] = c[ImGuiCol_FrameBgHovered] = hover;
    c[ImGuiCol_ButtonActive] = c[ImGuiCol_FrameBgActive] = accent;
    c[ImGuiCol_Header] = c[ImGuiCol_HeaderHovered] = accent;
    c[ImGuiCol_Border] = ImVec4(0, 0, 0, 0);
    c[ImGuiCol_ScrollbarBg] = back;
}

/* The first that is there; ImGui's own letters are pixels of one size. */
ImFont *load_font(float px)
{
    static const char *const paths[] = {
        "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
        "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
        "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
        "/usr/share/fonts/TTF/DejaVuSans.ttf",
        "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    };
    ImFontAtlas *atlas = ImGui::GetIO().Fonts;
    ImFontConfig own;

    for (const char *path : paths)
        if (!access(path, R_OK))
            return atlas->AddFontFromFileTTF(path, std::round(px));
    own.SizePixels = std::round(px);
    return atlas->AddFontDefault(&own);
}

/* Letters are made in pixels of the display and shown in units of the window: sharp on either. */
void measure(panel *p, GLFWwindow *window)
{
    float scale_x, scale_y;
    int width, unused, pixels;

    glfwGetWindowContentScale(window, &scale_x, &scale_y);
    glfwGetWindowSize(window, &width, &unused);
    glfwGetFramebufferSize(window, &pixels, &unused);
    const float density =
        width > 0 && pixels > 0 ? static_cast<float>(pixels) / static_cast<float>(width) : 1;
    p->scale = scale_x / density;
    p->text = load_font(text_px * scale_x);
    p->small = load_font(small_px * scale_x);
    ImGui::GetIO().FontGlobalScale = 1 / density;
}

} // namespace

panel *panel_open(void *glfw_window)
{
    GLFWwindow *window = static_cast<GLFWwindow *>(glfw_window);
    panel *p = static_cast<panel *>(calloc(1, sizeof(panel)));

    if (!p)
        return nullptr;
    p->context = ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    measure(p, window);
    set_style(p->scale);
    ImGui_ImplGlfw_InitForOpenGL(window, true); /* calls ours too */
    ImGui_ImplOpenGL3_Init("#version 330 core");
    return p;
}

void panel_close(panel *p)
{
    if (!p)
        return;
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext(p->context);
    free(p);
}

void panel_margins(const panel *p, const session *s, float *bottom, float *right)
{
    *bottom = p && s->panels ? bar_height * p->scale : 0;
    *right = p && s->panels && s->bars ? bars_width * p->scale : 0;
}

/* Where the fixed panels are is known without asking ImGui, whose answer is of the last picture: a quick hand is faster. */
int panel_has_mouse(const panel *p, const session *s, double x, double y)
{
    float bottom, right;

    if (!p)
        return 0;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    panel_margins(p, s, &bottom, &right);
    if (x >= static_cast<double>(size.x - right) || y >= static_cast<double>(size.y - bottom))
        return 1;
    const int over = s->help || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId);
    return over && ImGui::GetIO().WantCaptureMouse;
}

int panel_draw(panel *p, const panel_view *v, play_event *event, int room)
{
    pass d = { p, v, v->session, event, room, 0 };

    if (!p)
        return 0;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    labels(&d);
    if (d.s->panels) {
        title(&d);
        bottom_bar(&d);
        if (d.s->bars)
            bars(&d);
    }
    if (d.s->help)
        help(&d);
    message(&d);
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    return d.count;
}

#endif

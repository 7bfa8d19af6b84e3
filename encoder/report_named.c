/* SPDX-License-Identifier: BSD-2-Clause */
/* See report_named.h. */
#include <stdio.h>

#include <fap/tables.h>

#include "common/tool.h"
#include "encoder/report_named.h"

typedef const char *(*name_of)(int number);

static void say_names(const char *what, const uint32_t *frames, int count, name_of name)
{
    char text[512];
    size_t used = 0;

    text[0] = '\0';
    for (int i = 1; i <= count; i++)
        if (frames[i])
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s %u", used ? ", " : "", name(i),
                                     (unsigned)frames[i]);
    tool_note("%s, frames each: %s", what, used ? text : "none");
}

void report_named_say(const options *opt, const run_report *rep)
{
    const fap_naming_report *r = &rep->naming;

    if (!rep->named)
        return;
    if (opt->visemes)
        say_names("FAP 1, visemes", r->viseme_frames, FAP_VISEME_COUNT, fap_viseme_name);
    if (opt->expressions)
        say_names("FAP 2, expressions", r->expression_frames, FAP_EXPRESSION_COUNT, fap_expression_name);
    tool_note("  alone they would leave %.0f %% of the motion unsaid", 100 * r->left);
}

static void json_names(json *j, const char *key, const uint32_t *frames, int count, name_of name)
{
    json_open(j, key, '{');
    for (int i = 0; i <= count; i++)
        json_integer(j, i ? name(i) : "none", frames[i]);
    json_close(j, '}');
}

void report_named_json(json *j, const options *opt, const run_report *rep)
{
    const fap_naming_report *r = &rep->naming;

    if (!rep->named)
        return;
    json_open(j, "named", '{');
    if (opt->visemes)
        json_names(j, "viseme_frames", r->viseme_frames, FAP_VISEME_COUNT, fap_viseme_name);
    if (opt->expressions)
        json_names(j, "expression_frames", r->expression_frames, FAP_EXPRESSION_COUNT, fap_expression_name);
    json_number(j, "left", r->left);
    json_close(j, '}');
}

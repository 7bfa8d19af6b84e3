/* SPDX-License-Identifier: BSD-2-Clause */
/* See batch.h. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "common/file.h"
#include "common/tool.h"
#include "encoder/batch/batch.h"
#include "encoder/batch/claim.h"
#include "encoder/batch/summary.h"
#include "encoder/batch/worker.h"
#include "encoder/plot/plot.h"

typedef struct batch {
    const options *opt;
    items takes;
    worker worker[WORKER_MAX];
    int jobs, at_work;
    size_t done, next; /* takes done; the first that may still wait */
    char clock[ITEM_PATH_SIZE];
    time_t beaten;
    progress bar;
    char word[RESULT_VALUE_SIZE]; /* why it cannot go on */
} batch;

/* --- telling --- */

static void say_result(const batch *b, const result *r)
{
    if (*r->value[RESULT_error] && strcmp(r->value[RESULT_status], result_no_take))
        tool_error("%s: %s", r->value[RESULT_take], r->value[RESULT_error]);
    else if (!isatty(STDERR_FILENO))
        tool_note("%zu of %zu: %s: %s", b->done, b->takes.count, r->value[RESULT_take],
                  r->value[RESULT_status]);
}

static void count_done(batch *b, item *it, int say)
{
    result r;

    it->state = ITEM_DONE;
    b->done++;
    if (say && item_result(it, b->opt, &r)) {
        if (b->bar.drawn_us)
            fputs("\r\033[K", stderr);
        say_result(b, &r);
    }
    progress_step(&b->bar, (int64_t)b->done);
}

/* --- work --- */

static int start(batch *b, item *it, const char *claim)
{
    worker *w = b->worker;

    while (w->pid)
        w++;
    if (!worker_start(w, it, b->opt, claim)) {
        snprintf(b->word, sizeof b->word, "no more processes: %s", strerror(errno));
        claim_release(claim);
        return 0;
    }
    b->at_work++;
    return 1;
}

/* Done already, somebody else's, or ours from here on. 0: it cannot go on. */
static int try_item(batch *b, item *it)
{
    char claim[ITEM_PATH_SIZE];
    result r;

    if (item_result(it, b->opt, &r)) {
        count_done(b, it, 0);
        return 1;
    }
    if (!item_path(claim, it->ledger, ".claim") || !folder_make_for(claim) || !folder_make_for(it->stem)) {
        snprintf(b->word, sizeof b->word, "%.500s: %s", it->ledger, strerror(errno));
        return 0;
    }
    const int got = claim_get(claim, b->clock);
    if (got < 0)
        snprintf(b->word, sizeof b->word, "%.500s: %s", claim, strerror(errno));
    if (got <= 0)
        return !got;
    if (!item_result(it, b->opt, &r)) /* nor has anybody finished it while we looked */
        return start(b, it, claim);
    claim_release(claim);
    count_done(b, it, 0);
    return 1;
}

/* Keeps all hands busy, one look at each take. */
static int hand_out(batch *b)
{
    for (; b->next < b->takes.count && b->at_work < b->jobs; b->next++)
        if (b->takes.item[b->next].state == ITEM_WAITING && !try_item(b, &b->takes.item[b->next]))
            return 0;
    return 1;
}

static void beat(batch *b)
{
    const time_t now = time(NULL);

    if (now - b->beaten < CLAIM_BEAT_S)
        return;
    b->beaten = now;
    for (int i = 0; i < b->jobs; i++)
        if (b->worker[i].pid)
            claim_beat(b->worker[i].claim);
}

static int collect(batch *b)
{
    int ended = 0;

    for (int i = 0; i < b->jobs; i++)
        if (b->worker[i].pid && worker_ended(&b->worker[i], b->opt)) {
            b->at_work--;
            ended++;
            count_done(b, b->worker[i].it, 1);
        }
    return ended;
}

static void sleep_ms(long ms)
{
    const struct timespec t = { ms / 1000, ms % 1000 * 1000000 };
    nanosleep(&t, NULL);
}

/* To the end, also of what other machines work on: their claims may grow stale. */
static int work_all(batch *b)
{
    int going = 1;

    while (b->at_work || (going && b->done < b->takes.count)) {
        if (going)
            going = hand_out(b);
        beat(b);
        if (collect(b))
            continue;
        sleep_ms(b->at_work ? 20 : 1000);
        if (b->next == b->takes.count && b->at_work < b->jobs)
            b->next = 0;
    }
    return going;
}

/* --- the end --- */

static int write_summary(const batch *b, const summary *s)
{
    char csv[ITEM_PATH_SIZE], html[ITEM_PATH_SIZE];

    errno = ENAMETOOLONG;
    if (item_path(csv, b->opt->output, "/summary.csv") && summary_write_csv(s, csv) &&
        item_path(html, b->opt->output, "/index.html") && summary_write_html(s, html, b->opt->batch_path))
        return 1;
    tool_error("%s: the summary could not be written: %s", b->opt->output, strerror(errno));
    return 0;
}

static int sum_up(const batch *b)
{
    result *const row = calloc(b->takes.count + 1, sizeof *row);
    summary s = { .row = row };

    if (!row) {
        tool_error("%s: too many takes for this memory", b->opt->batch_path);
        return EXIT_DATA;
    }
    for (size_t i = 0; i < b->takes.count; i++)
        s.count += (size_t)item_result(&b->takes.item[i], b->opt, &row[s.count]);
    summary_count(&s);
    const int written = write_summary(b, &s);
    if (b->opt->json)
        summary_print_json(&s);
    tool_note("%s: %zu encoded, %zu failed, %zu no takes; %s/index.html", b->opt->batch_path, s.encoded,
              s.failed, s.no_take, b->opt->output);
    free(row);
    return written && !s.failed && s.count == b->takes.count ? EXIT_OK : EXIT_DATA;
}

static int prepare(batch *b)
{
    char ledger[ITEM_PATH_SIZE];
    FILE *f = NULL;

    errno = ENAMETOOLONG;
    if (item_path(ledger, b->opt->output, "/.batch") &&
        snprintf(b->clock, sizeof b->clock, "%s/.clock.XXXXXX", ledger) < (int)sizeof b->clock &&
        folder_make(ledger)) {
        const int fd = mkstemp(b->clock);
        f = fd < 0 ? NULL : fdopen(fd, "w");
    }
    if (!f) {
        tool_error("%s: %s", b->opt->output, strerror(errno));
        return 0;
    }
    fclose(f);
    return 1;
}

static int list(batch *b)
{
    const fap_err err = items_list(&b->takes, b->opt);

    if (err != FAP_OK)
        tool_error("%s: %s", b->opt->batch_path, err == FAP_E_IO ? strerror(errno) : fap_strerror(err));
    else if (!b->takes.count)
        tool_error("%s: no file in it that could be a take", b->opt->batch_path);
    return err == FAP_OK && b->takes.count;
}

/* Takes whose workers were shot in a batch before this one get another chance. */
static void forget_ended(const batch *b)
{
    char path[ITEM_PATH_SIZE];
    result r;

    for (size_t i = 0; i < b->takes.count; i++)
        if (item_path(path, b->takes.item[i].ledger, ".result") && result_read(&r, path) &&
            !strcmp(r.value[RESULT_status], result_ended))
            unlink(path);
}

static int jobs_of(const options *opt)
{
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    const long jobs = opt->jobs ? opt->jobs : processors > 0 ? processors : 1;

    return jobs < WORKER_MAX ? (int)jobs : WORKER_MAX;
}

static int run_listed(batch *b)
{
    workers_watch();
    forget_ended(b);
    if (!plot_available())
        tool_note("note: no curves: built without cairo (install libcairo2-dev and build again)");
    progress_start(&b->bar, "encoding", (int64_t)b->takes.count);
    const int whole = work_all(b);
    progress_end(&b->bar);
    unlink(b->clock);
    if (!whole)
        tool_error("%s", b->word);
    const int status = sum_up(b);
    return whole ? status : EXIT_DATA;
}

int batch_run(const options *opt)
{
    static batch b;
    int status = EXIT_DATA;

    b = (batch){ .opt = opt, .jobs = jobs_of(opt) };
    if (list(&b) && prepare(&b))
        status = run_listed(&b);
    items_free(&b.takes);
    return status;
}

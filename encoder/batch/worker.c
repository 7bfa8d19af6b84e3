/* SPDX-License-Identifier: BSD-2-Clause */
/* See worker.h. */
#include <errno.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "common/file.h"
#include "common/signals.h"
#include "common/tool.h"
#include "encoder/batch/claim.h"
#include "encoder/batch/worker.h"
#include "encoder/plot/plot.h"
#include "encoder/report.h"

/* --- the end by a signal --- */

/* What the handler has to end and to remove. Only the process that watches speaks: its workers inherit the handler. */
static _Atomic pid_t watcher;
static _Atomic(worker *) at_work[WORKER_MAX];

static void end_workers(void)
{
    if (getpid() != atomic_load(&watcher))
        return;
    for (int i = 0; i < WORKER_MAX; i++) {
        const worker *w = atomic_load(&at_work[i]);
        if (!w)
            continue;
        kill(w->pid, SIGTERM);
        unlink(w->claim);
    }
}

void workers_watch(void)
{
    atomic_store(&watcher, getpid());
    signals_call(end_workers);
}

static void remember(worker *w, worker *instead_of)
{
    for (int i = 0; i < WORKER_MAX; i++)
        if (atomic_load(&at_work[i]) == instead_of) {
            atomic_store(&at_work[i], w);
            return;
        }
}

/* --- in the worker --- */

static double seconds(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The options of this take; its paths are kept in @paths. */
static int own_options(options *own, const item *it, const options *opt, char paths[2][ITEM_PATH_SIZE])
{
    *own = *opt;
    own->command = COMMAND_ENCODE;
    own->input = it->input;
    own->output = paths[0];
    own->json = 1;
    own->plot_path = plot_available() ? paths[1] : NULL;
    return item_path(paths[0], it->stem, opt->batch_bits ? ".fba" : ".fap") &&
           item_path(paths[1], it->stem, ".svg");
}

/* The report as JSON beside the output. */
static int tell(const options *own, const item *it, const run_report *rep, fap_err err)
{
    char path[ITEM_PATH_SIZE];
    out_file report;

    if (err != FAP_OK || !item_path(path, it->stem, ".json") || out_file_open(&report, path) != FAP_OK)
        return report_print(own, rep, err);
    fflush(stdout);
    if (dup2(fileno(report.stream), STDOUT_FILENO) < 0)
        return EXIT_DATA;
    const int status = report_print(own, rep, err);
    fflush(stdout);
    return status == EXIT_OK && out_file_commit(&report) == FAP_OK ? EXIT_OK : EXIT_DATA;
}

static const char *relative(const options *opt, const char *path)
{
    return path + strlen(opt->output) + 1;
}

/* What is said on standard error belongs to the take, not to the batch. */
static void open_log(const item *it, char path[ITEM_PATH_SIZE])
{
    if (!item_path(path, it->ledger, ".log") || !freopen(path, "w", stderr))
        *path = '\0';
}

static void close_log(const char *path)
{
    struct stat s;

    fflush(stderr);
    if (*path && !stat(path, &s) && !s.st_size)
        unlink(path);
}

static int work(const item *it, const options *opt)
{
    static char paths[2][ITEM_PATH_SIZE], ledger[ITEM_PATH_SIZE], log[ITEM_PATH_SIZE];
    static result r;
    const double started_s = seconds();
    run_report rep = { 0 };
    options own;

    open_log(it, log);
    if (!own_options(&own, it, opt, paths) || !item_path(ledger, it->ledger, ".result"))
        return EXIT_DATA;
    /* Before it is read: a take that changes meanwhile is encoded again. */
    item_made_of(it, opt, r.value[RESULT_made_of]);
    const fap_err err = run(&own, &rep);
    const int status = tell(&own, it, &rep, err);
    result_set(&r, RESULT_take, "%s", it->name);
    result_set(&r, RESULT_output, "%s", err == FAP_OK ? relative(opt, own.output) : "");
    result_fill(&r, &rep, err);
    result_set(&r, RESULT_seconds, "%.2f", seconds() - started_s);
    run_close(&rep);
    close_log(log);
    return result_write(&r, ledger) ? status : EXIT_DATA;
}

/* --- around it --- */

int worker_start(worker *w, item *it, const options *opt, const char *claim)
{
    sigset_t before;

    *w = (worker){ .it = it };
    snprintf(w->claim, sizeof w->claim, "%s", claim);
    fflush(NULL);
    signals_hold(&before);
    w->pid = fork();
    if (w->pid > 0)
        remember(w, NULL);
    signals_release(&before);
    if (w->pid < 0)
        return 0;
    if (!w->pid)
        _exit(
            work(it, opt)); /* what was written is committed; the batch's own buffers are not ours to flush */
    it->state = ITEM_RUNNING;
    return 1;
}

/* A worker that did not come to writing its result. */
static void write_for(const worker *w, const options *opt, int status)
{
    char path[ITEM_PATH_SIZE];
    result r = { { "" } };

    item_made_of(w->it, opt, r.value[RESULT_made_of]);
    result_set(&r, RESULT_take, "%s", w->it->name);
    result_set(&r, RESULT_status, "%s", result_ended);
    if (WIFSIGNALED(status))
        result_set(&r, RESULT_error, "ended by signal %d (%s): please report it, with the take if you may",
                   WTERMSIG(status), strsignal(WTERMSIG(status)));
    else
        result_set(&r, RESULT_error,
                   "the result could not be written: is there room under the output folder?");
    if (item_path(path, w->it->ledger, ".result") && !result_write(&r, path))
        tool_error("%s: %s", path, strerror(errno));
}

int worker_ended(worker *w, const options *opt)
{
    result r;
    int status;

    if (waitpid(w->pid, &status, WNOHANG) != w->pid)
        return 0;
    if (!item_result(w->it, opt, &r))
        write_for(w, opt, status);
    w->it->state = ITEM_DONE;
    remember(NULL, w);
    claim_release(w->claim);
    w->pid = 0;
    return 1;
}

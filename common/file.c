/* SPDX-License-Identifier: BSD-2-Clause */
/* See file.h. */
#include <errno.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/file.h"
#include "common/signals.h"

static fap_err read_all(FILE *f, size_t max, uint8_t **data, size_t *size)
{
    size_t room = 64 << 10, used = 0;
    uint8_t *buf = malloc(room + 1);

    while (buf) {
        used += fread(buf + used, 1, room - used, f);
        if (used < room)
            break;
        if (used > max)
            break;
        room *= 2;
        uint8_t *grown = realloc(buf, room + 1);
        if (!grown)
            free(buf);
        buf = grown;
    }
    if (!buf)
        return FAP_E_NOMEM;
    if (ferror(f) || used > max) {
        const fap_err err = ferror(f) ? FAP_E_IO : FAP_E_LIMIT;
        free(buf);
        return err;
    }
    buf[used] = '\0';
    *data = buf;
    *size = used;
    return FAP_OK;
}

fap_err file_read(const char *path, size_t max, uint8_t **data, size_t *size)
{
    if (!strcmp(path, "-"))
        return read_all(stdin, max, data, size);

    FILE *f = fopen(path, "rb");
    if (!f)
        return errno == ENOENT ? FAP_E_NOT_FOUND : FAP_E_IO;
    const fap_err err = read_all(f, max, data, size);
    fclose(f);
    return err;
}

/* --- temporaries --- */

/* What a signal has to remove. One thread opens and commits; the handler reads. A name that finds no slot would be
 * left behind by a signal, and by nothing else. */
static _Atomic(const char *) pending[16];

enum { PENDING_COUNT = sizeof pending / sizeof *pending };

static void remove_pending(void)
{
    for (int i = 0; i < PENDING_COUNT; i++) {
        const char *const temp = atomic_load(&pending[i]);
        if (temp)
            unlink(temp);
    }
}

static void replace_pending(const char *old, const char *now)
{
    for (int i = 0; i < PENDING_COUNT; i++)
        if (atomic_load(&pending[i]) == old) {
            atomic_store(&pending[i], now);
            return;
        }
}

/* Signals wait from the moment the file exists until it is known to the handler. */
static int make_temporary(char *name)
{
    sigset_t before;

    signals_call(remove_pending);
    signals_hold(&before);
    const int fd = mkstemp(name);
    if (fd >= 0)
        replace_pending(NULL, name);
    signals_release(&before);
    return fd;
}

static void remove_temporary(const char *name)
{
    unlink(name);
    replace_pending(name, NULL);
}

/* mkstemp gives 0600; an output should get the mode that a plain fopen would have given it. */
static void apply_umask(int fd)
{
    const mode_t mask = umask(0);
    umask(mask);
    if (fchmod(fd, 0666 & ~mask))
        return; /* a file system without modes: nothing to keep */
}

fap_err out_file_open(out_file *f, const char *path)
{
    *f = (out_file){ 0 };
    if (!strcmp(path, "-")) {
        f->stream = stdout;
        return FAP_OK;
    }
    const size_t length = strlen(path);
    f->path = strdup(path);
    f->temp = malloc(length + sizeof ".XXXXXX");
    if (!f->path || !f->temp)
        goto fail;
    memcpy(f->temp, path, length);
    memcpy(f->temp + length, ".XXXXXX", sizeof ".XXXXXX");
    const int fd = make_temporary(f->temp);
    if (fd < 0)
        goto fail;
    apply_umask(fd);
    f->stream = fdopen(fd, "wb");
    if (f->stream)
        return FAP_OK;
    close(fd);
    remove_temporary(f->temp);
fail:
    free(f->path);
    free(f->temp);
    *f = (out_file){ 0 };
    return FAP_E_IO;
}

fap_err out_file_commit(out_file *f)
{
    if (!f->temp) {
        const int bad = fflush(f->stream) || ferror(f->stream);
        f->stream = NULL;
        return bad ? FAP_E_IO : FAP_OK;
    }
    const int bad = ferror(f->stream) | fclose(f->stream);
    f->stream = NULL;
    if (bad || rename(f->temp, f->path)) {
        out_file_abandon(f);
        return FAP_E_IO;
    }
    replace_pending(f->temp, NULL);
    free(f->temp);
    free(f->path);
    *f = (out_file){ 0 };
    return FAP_OK;
}

void out_file_abandon(out_file *f)
{
    if (f->temp) {
        if (f->stream)
            fclose(f->stream);
        remove_temporary(f->temp);
    }
    free(f->temp);
    free(f->path);
    *f = (out_file){ 0 };
}

static size_t read_file(void *user, void *buf, size_t size)
{
    const size_t n = fread(buf, 1, size, user);
    return n == 0 && ferror((FILE *)user) ? (size_t)-1 : n;
}

static int write_file(void *user, const void *data, size_t size)
{
    return fwrite(data, 1, size, user) != size;
}

fap_reader file_reader(FILE *f)
{
    return (fap_reader){ read_file, f };
}

fap_writer file_writer(FILE *f)
{
    return (fap_writer){ write_file, f };
}

/* SPDX-License-Identifier: BSD-2-Clause */
/* Mesh files, archives and subdivision: what is good is read, what is not is refused with a reason. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bank/format.h"
#include "shape/bytes.h"
#include "shape/inflate.h"
#include "shape/number.h"
#include "shape/obj.h"
#include "shape/subdivide.h"
#include "shape/target.h"
#include "shape/zip.h"

static fap_err parse(fap_obj *o, const char *text, int *line)
{
    return fap_obj_parse(o, text, strlen(text), line);
}

TEST(obj, reads_positions_coordinates_faces_and_groups)
{
    static const char text[] = "# a comment\nv 0 0 0\nv 1 0 0\r\nv 1 1 0\nv 0 1 .5e1\nvt 0.25 -1\n"
                               "g front\nf 1/1 2/1 3/1\ng back half\nf -4//7 3/1/2 4\ng front\nf 1 2 4 3\n";
    fap_obj o;

    assert_int_equal(parse(&o, text, NULL), FAP_OK);
    assert_int_equal(o.position_count, 4);
    assert_int_equal(o.face_count, 3);
    assert_float_equal(o.position[3][2], 5, 1e-6);
    assert_float_equal(o.uv[0][1], -1, 1e-6);
    assert_int_equal(o.face[0].group, fap_obj_group(&o, "front"));
    assert_int_equal(o.face[1].group, fap_obj_group(&o, "back"));
    assert_int_equal(o.face[2].group, o.face[0].group);
    assert_int_equal(o.vertex[o.face[1].first], 0);
    assert_int_equal(o.corner_uv[o.face[1].first], FAP_OBJ_NO_UV);
    assert_int_equal(o.corner_uv[o.face[1].first + 1], 0);
    assert_int_equal(fap_obj_group(&o, "nobody"), UINT32_MAX);
    fap_obj_free(&o);
}

TEST(obj, says_which_line_is_bad)
{
    static const char *const bad[] = {
        "v 0 0 0\nv 0 0\n",      "v 0 0 0\nv a b c\n",    "v 0 0 0\nf 1 1\n",
        "v 0 0 0\nf 1 1 2\n",    "v 0 0 0\nf 0 1 1\n",    "v 0 0 0\nf 1 1 -2\n",
        "v 0 0 0\nf 1/1 1 1\n",  "v 0 0 0\nf 1/ 1 1\n",   "v 0 0 0\nv nan 0 0\n",
        "v 0 0 0\nv 1e99 0 0\n", "v 0 0 0\nf 1//x 1 1\n", "v 0 0 0\nf 99999999999999999999 1 1\n",
    };

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        fap_obj o;
        int line = 0;
        assert_int_equal(parse(&o, bad[i], &line), FAP_E_SYNTAX);
        assert_int_equal(line, 2);
        assert_null(o.position);
    }
    fap_obj o;
    assert_int_equal(fap_obj_parse(&o, "v 0 0\0", 6, NULL), FAP_E_SYNTAX);
}

TEST(obj, nothing_is_a_mesh_without_faces)
{
    fap_obj o;
    assert_int_equal(parse(&o, "", NULL), FAP_OK);
    assert_int_equal(o.face_count, 0);
    fap_obj_free(&o);
}

TEST(number, is_read_whatever_its_dress)
{
    float v[5];

    assert_true(fap_read_floats(" 1 -.5 +2. 3e2 4E-2", v, 5));
    assert_float_equal(v[0], 1, 0);
    assert_float_equal(v[1], -0.5, 1e-7);
    assert_float_equal(v[2], 2, 0);
    assert_float_equal(v[3], 300, 1e-4);
    assert_float_equal(v[4], 0.04, 1e-7);
    assert_false(fap_read_floats("1 2", v, 3));
    assert_false(fap_read_floats(".", v, 1));
    assert_false(fap_read_floats("1e", v, 1));
    assert_false(fap_read_floats("inf", v, 1));
}

TEST(target, adds_weighted_motion)
{
    float d[3][3] = { { 1, 0, 0 } };
    int line;

    assert_int_equal(fap_target_add("# head\n0 1 2 3\n\n2 -.5 0 .25\r\n", 2, d, 3, &line), FAP_OK);
    assert_float_equal(d[0][0], 3, 1e-6);
    assert_float_equal(d[0][2], 6, 1e-6);
    assert_float_equal(d[2][0], -1, 1e-6);
    assert_float_equal(d[2][2], 0.5, 1e-6);
}

TEST(target, refuses_bad_lines)
{
    float d[3][3] = { { 0 } };
    int line = 0;

    assert_int_equal(fap_target_add("0 1 1 1\n3 1 1 1\n", 1, d, 3, &line), FAP_E_DATA);
    assert_int_equal(line, 2);
    assert_int_equal(fap_target_add("-1 1 1 1\n", 1, d, 3, &line), FAP_E_DATA);
    assert_int_equal(fap_target_add("0 1 1\n", 1, d, 3, &line), FAP_E_SYNTAX);
    assert_int_equal(fap_target_add("x 1 1 1\n", 1, d, 3, &line), FAP_E_SYNTAX);
}

/* --- zip --- */

static const uint8_t hello_deflated[] = {
    0xcb, 0x48, 0xcd, 0xc9, 0xc9, 0x07, 0x00
}; /* "hello", fixed codes */

static void put_local(fap_bytes *z, int method, const uint8_t *data, uint32_t packed, uint32_t size,
                      const char *name)
{
    fap_bytes_put(z, "PK\3\4\24\0\0\0", 8);
    fap_bytes_16(z, (uint16_t)method);
    fap_bytes_32(z, 0);
    fap_bytes_32(z, fbank_crc32((const uint8_t *)"hello", 5));
    fap_bytes_32(z, packed);
    fap_bytes_32(z, size);
    fap_bytes_16(z, (uint16_t)strlen(name));
    fap_bytes_16(z, 0);
    fap_bytes_put(z, name, strlen(name));
    fap_bytes_put(z, data, packed);
}

static void put_central(fap_bytes *z, int method, uint32_t packed, uint32_t size, const char *name,
                        uint32_t local)
{
    fap_bytes_put(z, "PK\1\2\24\0\24\0\0\0", 10);
    fap_bytes_16(z, (uint16_t)method);
    fap_bytes_32(z, 0);
    fap_bytes_32(z, fbank_crc32((const uint8_t *)"hello", 5));
    fap_bytes_32(z, packed);
    fap_bytes_32(z, size);
    fap_bytes_16(z, (uint16_t)strlen(name));
    fap_bytes_put(z, "\0\0\0\0\0\0\0\0\0\0\0\0", 12);
    fap_bytes_32(z, local);
    fap_bytes_put(z, name, strlen(name));
}

/* Two entries holding "hello": "stored" and "packed"; @p lie is added to the unpacked size of both. */
static fap_bytes make_zip(uint32_t lie)
{
    fap_bytes z = { 0 };

    put_local(&z, 0, (const uint8_t *)"hello", 5, 5, "stored");
    const uint32_t second = (uint32_t)z.size;
    put_local(&z, 8, hello_deflated, sizeof hello_deflated, 5, "packed");
    const uint32_t directory = (uint32_t)z.size;
    put_central(&z, 0, 5, 5 + lie, "stored", 0);
    put_central(&z, 8, sizeof hello_deflated, 5 + lie, "packed", second);
    const uint32_t directory_size = (uint32_t)z.size - directory;
    fap_bytes_put(&z, "PK\5\6\0\0\0\0\2\0\2\0", 12);
    fap_bytes_32(&z, directory_size);
    fap_bytes_32(&z, directory);
    fap_bytes_16(&z, 0);
    return z;
}

static fap_err extract(const fap_bytes *z, size_t size, const char *name, size_t max)
{
    fap_zip zip;
    uint8_t *out = NULL;
    size_t out_size = 0;

    fap_err err = fap_zip_open(&zip, z->data, size);
    if (!err)
        err = fap_zip_extract(&zip, name, max, &out, &out_size);
    if (!err) {
        assert_int_equal(out_size, 5);
        assert_string_equal((char *)out, "hello");
    }
    free(out);
    return err;
}

TEST(zip, gives_stored_and_deflated_entries)
{
    fap_bytes z = make_zip(0);

    assert_int_equal(extract(&z, z.size, "stored", 100), FAP_OK);
#ifdef HAVE_ZLIB
    assert_int_equal(extract(&z, z.size, "packed", 100), FAP_OK);
#endif
    assert_int_equal(extract(&z, z.size, "absent", 100), FAP_E_NOT_FOUND);
    assert_int_equal(extract(&z, z.size, "stored", 4), FAP_E_LIMIT);
    fap_bytes_free(&z);
}

TEST(zip, does_not_believe_wrong_sizes)
{
    fap_bytes z = make_zip(1);

    assert_int_equal(extract(&z, z.size, "stored", 100), FAP_E_DATA);
#ifdef HAVE_ZLIB
    assert_int_equal(extract(&z, z.size, "packed", 100), FAP_E_DATA);
#endif
    fap_bytes_free(&z);
}

TEST(zip, notices_damage_to_the_content)
{
    fap_bytes z = make_zip(0);

    z.data[30 + 6] ^= 1; /* the h of hello */
    assert_int_equal(extract(&z, z.size, "stored", 100), FAP_E_DATA);
    fap_bytes_free(&z);
}

TEST(zip, survives_being_cut_anywhere)
{
    fap_bytes z = make_zip(0);

    for (size_t size = 0; size < z.size; size++)
        assert_int_not_equal(extract(&z, size, "packed", 100), FAP_OK);
    fap_bytes_free(&z);
}

TEST(zip, survives_any_wrong_byte)
{
    fap_bytes z = make_zip(0);

    for (size_t i = 0; i < z.size; i++) {
        z.data[i] ^= 0xff; /* whatever comes of it, extract() has checked "hello" where it says FAP_OK */
        const fap_err err = extract(&z, z.size, "stored", 100);
        assert_true(err <= FAP_OK);
        z.data[i] ^= 0xff;
    }
    fap_bytes_free(&z);
}

#ifdef HAVE_ZLIB
TEST(gunzip, refuses_what_is_cut_or_too_large)
{
    /* gzip of 5 bytes "hello" */
    static const uint8_t gz[] = { 0x1f, 0x8b, 8,    0,    0,    0,    0,    0,    0, 3, 0xcb, 0x48, 0xcd,
                                  0xc9, 0xc9, 0x07, 0x00, 0x86, 0xa6, 0x10, 0x36, 5, 0, 0,    0 };
    uint8_t *out;
    size_t size;

    assert_int_equal(fap_gunzip(gz, sizeof gz, 100, &out, &size), FAP_OK);
    assert_string_equal((char *)out, "hello");
    free(out);
    for (size_t cut = 0; cut < sizeof gz; cut++)
        assert_int_equal(fap_gunzip(gz, cut, 100, &out, &size), FAP_E_DATA);
    assert_int_equal(fap_gunzip(gz, sizeof gz, 4, &out, &size), FAP_E_LIMIT);
}
#endif

/* --- subdivision --- */

static const uint32_t cube_start[] = { 0, 4, 8, 12, 16, 20, 24 };
static const uint32_t cube[] = { 0, 1, 3, 2, 4, 6, 7, 5, 0, 4, 5, 1, 2, 3, 7, 6, 0, 2, 6, 4, 1, 5, 7, 3 };

static void cube_corners(float p[8][3])
{
    for (int v = 0; v < 8; v++)
        for (int axis = 0; axis < 3; axis++)
            p[v][axis] = v >> axis & 1 ? 1 : -1;
}

TEST(subdivide, cube_has_the_places_of_the_paper)
{
    const fap_polygons mesh = { 6, 8, cube_start, cube };
    fap_subdivision s;
    float in[8][3], out[26][3];

    cube_corners(in);
    assert_int_equal(fap_subdivide(&s, &mesh), FAP_OK);
    assert_int_equal(s.vertex_count, 8 + 12 + 6);
    assert_int_equal(s.quad_count, 24);
    fap_subdivision_apply(&s, (const float(*)[3])in, out);
    assert_float_equal(fabsf(out[0][0]), 5.0 / 9, 1e-5); /* corner: (Q + 2 R) / 3 = (1/3 + 4/3) / 3 */
    for (int e = 8; e < 20; e++) {                       /* edge: two coordinates 3/4, one 0 */
        const float sum = fabsf(out[e][0]) + fabsf(out[e][1]) + fabsf(out[e][2]);
        assert_float_equal(sum, 1.5, 1e-5);
    }
    for (int f = 20; f < 26; f++)
        assert_float_equal(fabsf(out[f][0]) + fabsf(out[f][1]) + fabsf(out[f][2]), 1, 1e-5);
    fap_subdivision_free(&s);
}

TEST(subdivide, weights_of_every_vertex_sum_to_one)
{
    const fap_polygons mesh = { 5, 8, cube_start, cube }; /* one face open: borders too */
    fap_subdivision s;

    assert_int_equal(fap_subdivide(&s, &mesh), FAP_OK);
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        float sum = 0;
        for (uint32_t i = s.row[v]; i < s.row[v + 1]; i++)
            sum += s.weight[i];
        assert_float_equal(sum, 1, 1e-5);
    }
    fap_subdivision_free(&s);
}

TEST(subdivide, keeps_a_flat_sheet_flat_and_its_border_straight)
{
    static const uint32_t start[] = { 0, 4, 8 }, vertex[] = { 0, 1, 4, 3, 1, 2, 5, 4 };
    static const float in[6][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 },
                                    { 0, 1, 0 }, { 1, 1, 0 }, { 2, 1, 0 } };
    const fap_polygons mesh = { 2, 6, start, vertex };
    fap_subdivision s;
    float out[16][3];

    assert_int_equal(fap_subdivide(&s, &mesh), FAP_OK);
    fap_subdivision_apply(&s, in, out);
    assert_float_equal(out[1][0], 1, 1e-6);
    assert_float_equal(out[1][1], 0, 1e-6);
    for (uint32_t v = 0; v < s.vertex_count; v++)
        assert_float_equal(out[v][2], 0, 1e-6);
    fap_subdivision_free(&s);
}

TEST(subdivide, refuses_meshes_it_cannot_split)
{
    static const uint32_t start[] = { 0, 3, 6, 9 }, three[] = { 0, 1, 2, 1, 0, 3, 0, 1, 4 },
                          beyond[] = { 0, 1, 9 };
    static const uint32_t thin[] = { 0, 2 };
    fap_subdivision s;

    assert_int_equal(fap_subdivide(&s, &(fap_polygons){ 3, 5, start, three }), FAP_E_DATA);
    assert_int_equal(fap_subdivide(&s, &(fap_polygons){ 1, 5, start, beyond }), FAP_E_DATA);
    assert_int_equal(fap_subdivide(&s, &(fap_polygons){ 1, 5, thin, three }), FAP_E_DATA);
    assert_null(s.row);
}

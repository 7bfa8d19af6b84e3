/* SPDX-License-Identifier: BSD-2-Clause */
#include "player/window/keys.h"
#include "tests/test.h"

TEST(play_keys, every_key_does_one_thing)
{
    for (const play_key *a = play_keys; a->key; a++)
        for (const play_key *b = a + 1; b->key; b++)
            assert_int_not_equal(a->key, b->key);
}

TEST(play_keys, every_line_of_the_help_says_something)
{
    assert_non_null(play_keys[0].label);
    for (const play_key *k = play_keys; k->key; k++)
        assert_true(!k->label == !k->help);
}

TEST(play_keys, act_as_typed_and_toggles_do_not_repeat)
{
    assert_int_equal(play_key_event(' ', 0).action, PLAY_PAUSE);
    assert_int_equal(play_key_event(' ', 1).action, PLAY_NOTHING);
    assert_int_equal(play_key_event('W', 0).action, PLAY_WIREFRAME);
    assert_int_equal(play_key_event(PLAY_KEY_RIGHT, 1).action, PLAY_STEP);
    assert_float_equal(play_key_event(PLAY_KEY_LEFT, 0).value, -1, 0);
    assert_float_equal(play_key_event('3', 0).value, CAMERA_RIGHT, 0);
    assert_int_equal(play_key_event('x', 0).action, PLAY_NOTHING);
    assert_int_equal(play_key_event(0, 0).action, PLAY_NOTHING);
    assert_int_equal(play_key_event(-1, 0).action, PLAY_NOTHING);
}

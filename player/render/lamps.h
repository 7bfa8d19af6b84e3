/* SPDX-License-Identifier: BSD-2-Clause */
/* Where the key lamp stands, for C and for the shaders. */
#ifndef PLAYER_RENDER_LAMPS_H
#define PLAYER_RENDER_LAMPS_H

#define KEY_FROM -0.55, 0.62, 0.78

#define LAMP_WORDS(...)  #__VA_ARGS__
#define LAMP_TEXT(place) LAMP_WORDS(place)

#endif

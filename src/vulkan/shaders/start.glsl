// SPDX-License-Identifier: Apache-2.0
// The numbers of a light's rays and of the frame, as written by layout.cpp: the ray through the first point, by which
// others of a near light differ, the grid's step, and the map from mm on the sensor to pixels.
#define START_X 0
#define START_Y 1
#define START_DX 2
#define START_DY 3
#define START_DZ 4
#define START_PER_DISTANCE 5
#define START_FLUX 6
#define START_DIVERGES 7
#define START_STEP_X 8
#define START_STEP_Y 9
#define START_PIXEL_X 10
#define START_PIXEL_Y 11
#define START_SCALE_X 12
#define START_SCALE_Y 13

"""Crops and scales frames of cameras."""

import cv2
import numpy as np

from procs.vision.colours import Picture


def central_part(frame: Picture, aspect: float) -> Picture:
    """Returns the largest central part of a frame whose width is `aspect` times its height."""
    height_px, width_px = frame.shape[:2]
    wanted_width_px = max(1, min(width_px, round(height_px * aspect)))
    wanted_height_px = max(1, min(height_px, round(width_px / aspect)))
    top, left = (height_px - wanted_height_px) // 2, (width_px - wanted_width_px) // 2
    return frame[top : top + wanted_height_px, left : left + wanted_width_px]


def scaled(frame: Picture, width_px: int, height_px: int) -> Picture:
    """Returns the frame in another size; the same frame if it has that size."""
    if frame.shape[:2] == (height_px, width_px):
        return frame
    method = cv2.INTER_AREA if width_px < frame.shape[1] else cv2.INTER_LINEAR
    return np.asarray(cv2.resize(frame, (width_px, height_px), interpolation=method), np.uint8)

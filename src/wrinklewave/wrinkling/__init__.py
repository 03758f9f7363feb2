"""Wrinkling models and the wrinkled surface that they make of a smooth one."""

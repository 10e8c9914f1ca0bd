extends RefCounted
## The size of all text on the screen, as a share of the size that the scenes give it.

## What the settings offer, in percent.
const CHOICES_PERCENT: PackedInt32Array = [100, 125, 150, 200]
## Where a control keeps the font size that its scene gave it.
const BASE_SIZE := &"base_font_size"


## Sizes the text of `top` and of all controls below it. percent: one of CHOICES_PERCENT. A control that draws its own text
## has a method set_text_scale(scale: float), which is called with 1.0 for 100 %.
static func apply(top: Node, percent: int) -> void:
	var controls := top.find_children("*", "Control", true, false)
	if top is Control:
		controls.append(top)
	for control: Control in controls:
		if control.has_method(&"set_text_scale"):
			control.call(&"set_text_scale", percent / 100.0)
		_resize(control, percent)
		if control is OptionButton:
			_resize((control as OptionButton).get_popup(), percent)


## item: a Control or a Window; both have theme overrides by the same methods.
static func _resize(item: Node, percent: int) -> void:
	if not item.has_meta(BASE_SIZE):
		item.set_meta(BASE_SIZE, item.call(&"get_theme_font_size", &"font_size"))
	var size := roundi(int(item.get_meta(BASE_SIZE)) * percent / 100.0)
	item.call(&"add_theme_font_size_override", &"font_size", size)

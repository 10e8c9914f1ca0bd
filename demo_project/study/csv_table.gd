extends RefCounted
## Writes a CSV file: a header, then rows given as dictionaries by column name. A value that is not
## known is left empty; a column that does not exist is an error, not a new column.

const DECIMALS := 6

var columns: PackedStringArray
var _lines: PackedStringArray = []


func _init(columns_: PackedStringArray) -> void:
	columns = columns_
	_lines.append(",".join(columns))


func add_row(values: Dictionary) -> void:
	var cells := PackedStringArray()
	for column in columns:
		cells.append(_cell(values.get(column)))
	for key: String in values:
		if not columns.has(key):
			push_error("CSV column %s does not exist" % key)
	_lines.append(",".join(cells))


## The rows without the header, ready to be appended.
func rows_text() -> String:
	return "" if _lines.size() < 2 else "\n".join(_lines.slice(1)) + "\n"


func save(path: String) -> Error:
	var file := FileAccess.open(path, FileAccess.WRITE)
	if file == null:
		var error := FileAccess.get_open_error()
		push_error("%s cannot be written: %s" % [path, error_string(error)])
		return error
	file.store_string("\n".join(_lines) + "\n")
	file.close()
	return OK


func _cell(value: Variant) -> String:
	match typeof(value):
		TYPE_NIL:
			return ""
		TYPE_BOOL:
			return "1" if value else "0"
		TYPE_FLOAT:
			var number: float = value
			return String.num(number, DECIMALS) if is_finite(number) else ""
	var text := str(value)
	if text.contains(",") or text.contains('"') or text.contains("\n"):
		return '"' + text.replace('"', '""') + '"'
	return text
